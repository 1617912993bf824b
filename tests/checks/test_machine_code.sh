#!/usr/bin/env bash
# No multiply-add is contracted: neither in the release objects as built nor with the same flags for a processor that
# has the instruction, with GCC and with Clang. There fma() calls stay calls (-fno-builtin-fma), so every multiply-add
# instruction is a contraction. That the check can fail is tried first, with contraction switched on.
# And the hot loops are vectors: what GCC makes of the lane functions for AVX2 holds packed arithmetic.
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

# Packed additions, multiplications, divisions and roots of four numbers in the AVX2 versions of the lane functions:
# three quarters at least of what GCC 12 makes. Without vectors there is none.
count_packed() {
    objdump -d --no-show-raw-insn "$1" | awk '
        /^[0-9a-f]+ <.*>:$/ { in_lanes = /\.avx2>:$/ }
        in_lanes && /[ \t]v(add|sub|mul|div|sqrt)p[ds] .*%ymm/ { ++num }
        END { print num + 0 }'
}
objects=$build/CMakeFiles/scree.dir/src
if readelf -p .comment "$objects/forces/gather_cpu.c.o" | grep clang >/dev/null || grep SCREE_CHECKED "$scratch/commands" >/dev/null; then
    echo "packed arithmetic of the hot loops: skipped, only GCC's optimised builds have versions for AVX2 (SCREE_LANES_FUNCTION)"
else
    probe=$(awk -F'\t' '$1 ~ /gather_cpu.c$/ { print $2 }' "$scratch/commands")
    (cd "$build" && bash -c "$probe -fno-tree-vectorize -o $scratch/probe.o") || exit 1
    [ "$(count_packed "$scratch/probe.o")" -lt 25 ] ||
        { echo "without vectorising, packed arithmetic is found: the check sees nothing"; exit 1; }
    while read -r source floor; do
        num=$(count_packed "$objects/$source.c.o")
        echo "$source: $num packed instructions"
        [ "$num" -ge "$floor" ] || echo "src/$source.c: $num packed instructions, expected $floor at least: not vectorised" >>"$scratch/faults"
    done <<'FLOORS'
forces/contact_force_cpu 230
forces/work_cpu 50
forces/gather_cpu 25
contact/sphere_contacts_cpu 27
contact/sphere_meshes_cpu 62
dynamics/integrator_cpu 80
FLOORS
fi
finish "sources compiled for a processor with multiply-add" "$(wc -l <"$scratch/commands")" "$scratch/faults"
