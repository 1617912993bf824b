#!/usr/bin/env bash
# Runs one regression test as two compilers built it: their lines "hash NAME VALUE" must be the same.
set -euo pipefail
for program in "$1" "$2"; do
    [ -x "$program" ] || { echo "$program has not been built"; exit 1; }
done
first=$("$1" | grep '^hash ') || { echo "$1 failed or printed no hash"; exit 1; }
second=$("$2" | grep '^hash ') || { echo "$2 failed or printed no hash"; exit 1; }
if [ "$first" != "$second" ]; then
    printf 'the compilers disagree\n%s:\n%s\n%s:\n%s\n' "$1" "$first" "$2" "$second"
    exit 1
fi
printf 'the same from both:\n%s\n' "$first"
