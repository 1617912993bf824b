#!/usr/bin/env bash
# Files have at most 800 lines, functions 80, parameter lists eight (five are aimed at); nothing is left to be done.
. "$(dirname "$0")/common.sh"
mapfile -t files < <(sources '*.c' '*.h' '*.cu' '*.cuh' '*.cpp' '*.py')
mapfile -t code < <(sources '*.c' '*.h' '*.cu' '*.cuh' '*.cpp')
wc -l "${files[@]}" | awk '$2 != "total" && $1 > 800 {print $2 ": has " $1 " lines; 800 are allowed"}' >"$scratch/faults"

# functions that ctags finds, with their first and last line and their signature
ctags --languages=C,C++,CUDA --langmap=CUDA:+.cuh --c-kinds=f --c++-kinds=f --cuda-kinds=f --fields=+neS -f - \
    "${code[@]}" 2>/dev/null | awk -F'\t' '!/^!/ {
    first = last = 0; signature = ""
    for (i = 4; i <= NF; ++i) {
        if ($i ~ /^line:/) first = substr($i, 6)
        if ($i ~ /^end:/) last = substr($i, 5)
        if ($i ~ /^signature:/) signature = substr($i, 11)
    }
    ++num
    if (last - first + 1 > 80) print $2 ":" first ": " $1 "() has " last - first + 1 " lines; 80 are allowed"
    if ($2 ~ /^(src|include)\// && gsub(/,/, ",", signature) > 7 && signature !~ /\.\.\./)
        print $2 ":" first ": " $1 "() has more than eight parameters; give it a struct"
} END { print num > "'"$scratch"'/num" }' >>"$scratch/faults"
grep -nE '\b(TODO|FIXME|XXX|HACK)\b' "${files[@]}" | sed 's/$/ : left to be done/' >>"$scratch/faults"
finish "sizes of functions" "$(cat "$scratch/num")" "$scratch/faults"
