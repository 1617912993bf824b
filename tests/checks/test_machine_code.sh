#!/usr/bin/env bash
# No multiply-add is contracted: neither in the release objects as built nor with the same flags for a processor that
# has the instruction, with GCC and with Clang. There fma() calls stay calls (-fno-builtin-fma), so every multiply-add
# instruction is a contraction. That the check can fail is tried first, with contraction switched on.
. "$(dirname "$0")/common.sh"
[ "$(uname -m)" = x86_64 ] || { echo "skipped: knows the instructions of x86-64 only"; exit 77; }
[ -f "$build/libscree.a" ] || { echo "$build/libscree.a has not been built"; exit 1; }
fused='\bvf(n?m(add|sub)|maddsub|msubadd)[0-9]*[sp][sd]\b'
: >"$scratch/faults"

objdump -d --no-show-raw-insn "$build/libscree.a" >"$scratch/disassembly"
grep mulsd "$scratch/disassembly" >/dev/null || { echo "the disassembly holds no multiplication at all"; exit 1; }
if ! grep -e '-march=native' "$build/compile_commands.json" >/dev/null; then # there fma() itself is such an instruction
    grep -oE "$fused" "$scratch/disassembly" | sort | uniq -c | sed 's/$/ in the release objects/' >>"$scratch/faults"
fi

# the build's own commands, without their output: "source TAB command"
python3 - "$build/compile_commands.json" >"$scratch/commands" <<'PYTHON'
import json, re, sys
for entry in json.load(open(sys.argv[1])):
    if " -o CMakeFiles/scree.dir/" in entry["command"]:
        print(entry["file"], re.sub(r" -o \S+ -c ", " -c ", entry["command"]), sep="\t")
PYTHON
assemble() {
    local source=$1 command=$2 compiler=$3
    shift 3
    # as cmake/compiler.cmake does for such processors: GCC 12.2 contracts in its vectoriser of straight-line code
    [ "$compiler" = gcc ] && set -- -fno-tree-slp-vectorize "$@"
    bash -c "$compiler ${command#* } -march=haswell -fno-builtin-fma -fno-builtin-fmaf -w -S -o - $*"
}
probe=$(awk -F'\t' '$1 ~ /forces_cpu.c$/' "$scratch/commands")
for compiler in gcc clang; do
    assemble "${probe%%$'\t'*}" "${probe#*$'\t'}" $compiler -ffp-contract=fast | grep -E "$fused" >/dev/null ||
        { echo "$compiler: with contraction on, no multiply-add is found: the check sees nothing"; exit 1; }
    while IFS=$'\t' read -r source command; do
        assemble "$source" "$command" $compiler >"$scratch/assembly" || echo "$source: $compiler failed" >>"$scratch/faults"
        grep -oE "$fused" "$scratch/assembly" | sort | uniq -c |
            sed "s|\$| contracted by $compiler in ${source#"$root"/}|" >>"$scratch/faults"
    done <"$scratch/commands"
done
finish "sources compiled for a processor with multiply-add" "$(wc -l <"$scratch/commands")" "$scratch/faults"
