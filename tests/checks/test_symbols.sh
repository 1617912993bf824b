#!/usr/bin/env bash
# Every exported symbol of the library starts with scree_, and the library calls nothing that prints, exits or aborts.
. "$(dirname "$0")/common.sh"
library=$build/libscree.a
[ -f "$library" ] || { echo "$library has not been built"; exit 1; }
nm -g --defined-only "$library" | awk 'NF == 3 {print $3}' | sort -u >"$scratch/exported"
grep -v '^scree_' "$scratch/exported" | sed 's/$/: exported without scree_/' >"$scratch/faults"
nm -u -A "$library" | awk '{print $1, $NF}' |
    grep -E ' (printf|vprintf|puts|putchar|perror|stdout|stderr|__printf_chk|exit|_exit|_Exit|quick_exit|abort|__assert_fail|raise)$' |
    sed 's/$/ : the library never prints, exits or aborts/' >>"$scratch/faults"
finish "exported symbols" "$(wc -l <"$scratch/exported")" "$scratch/faults"
