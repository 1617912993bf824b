#!/usr/bin/env bash
# Every source is formatted as .clang-format says (`make format` does it).
. "$(dirname "$0")/common.sh"
version=$(clang-format --version | grep -o '[0-9]*' | head -n 1)
if [ "$version" != 14 ]; then
    echo "skipped: clang-format 14 decides, and this is $version"
    exit 77
fi
mapfile -t files < <(sources '*.c' '*.h' '*.cu' '*.cuh' '*.cpp')
clang-format --dry-run -Werror "${files[@]}" 2>&1 | grep 'error:' | sed 's/:[0-9]*: error:.*//' |
    awk -F: '!seen[$1]++ {print $1 ":" $2 ": is not formatted: run make format"}' >"$scratch/faults"
finish "formatting" ${#files[@]} "$scratch/faults"
