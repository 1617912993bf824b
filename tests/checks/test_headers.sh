#!/usr/bin/env bash
# Every header compiles alone: in C with both compilers, in both precisions, and the public ones and the kernels in C++.
. "$(dirname "$0")/common.sh"
mapfile -t headers < <(find include src -name '*.h' | LC_ALL=C sort)
flags="-Iinclude -Isrc $(pkg-config --cflags hdf5-serial libcyaml yaml-0.1 assimp) -fopenmp"

compile() {
    local header=$1 name=${1#include/}
    name=${name#src/}
    shift
    printf '#include "%s"\n' "$name" | "$@" $flags -Wall -Wextra -Werror -fsyntax-only - 2>"$scratch/log" ||
        { echo "$header: does not compile alone with $*"; grep -m 3 error "$scratch/log"; } >>"$scratch/faults"
}
: >"$scratch/faults"
for header in "${headers[@]}"; do
    compile "$header" gcc -std=c17 -x c
    compile "$header" clang -std=c17 -x c
    compile "$header" gcc -std=c17 -x c -DSCREE_SINGLE=1
    case $header in
    include/* | *_kernel.h) compile "$header" g++ -std=c++17 -x c++ ;;
    esac
done
finish "headers" ${#headers[@]} "$scratch/faults"
