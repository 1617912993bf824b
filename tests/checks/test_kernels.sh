#!/usr/bin/env bash
# Kernels keep to the common subset of C17 and CUDA C++ and to arithmetic that is the same everywhere; each kernel that
# is launched on the CPU is launched in a .cu file too, and by a test of the CUDA side.
. "$(dirname "$0")/common.sh"
mapfile -t kernels < <(find src -name '*_kernel.h' -o -path src/core/vec.h -o -path src/core/exact_arith.h | LC_ALL=C sort)
: >"$scratch/faults"

# The code without its comments and strings.
bare() { gcc -fpreprocessed -dD -E -P -x c "$1" 2>/dev/null | sed 's/"[^"]*"/""/g'; }
# A fault for each thing in $scratch/bare that matches.
forbid() {
    local file=$1 pattern=$2 why=$3
    grep -oE "$pattern" "$scratch/bare" | sort -u | sed "s|^|$file: |; s|\$| : $why|" >>"$scratch/faults"
}
for file in "${kernels[@]}"; do
    bare "$file" >"$scratch/bare"
    forbid "$file" '\b(pow|exp|exp2|log|log2|log10|sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|cbrt|hypot|fmod|remainder)f?\(' \
        "differs between libraries; compute it once on the host"
    forbid "$file" '\b(fmin|fmax)f?\(' "leaves the sign of zero open; use scree_min, scree_max"
    forbid "$file" '\b(malloc|calloc|realloc|free|printf|rand|clock|time)\(' "kernels have no state but their arguments"
    forbid "$file" '\bstatic (const|int|float|double|scree_|char|struct|void|bool|u?int)' "kernels have no statics (functions are SCREE_FN)"
    forbid "$file" '\b(goto|_Generic)\b' "not in the common subset"
    forbid "$file" '[{,] *\.[a-z_]+ *= ' "designated initialisers are not in the common subset"
    forbid "$file" '\((scree_[a-z0-9_]+|double|float)(\[\])?\)[ ]*\{' "compound literals are not in the common subset"
done
# fma() rounds once: only exact_arith.h may want that
while read -r file; do
    [ "$file" = src/core/exact_arith.h ] && continue
    bare "$file" >"$scratch/bare"
    forbid "$file" '\bfmaf?\(' "only src/core/exact_arith.h calls fma()"
done < <(grep -rlw 'fmaf\?' src | LC_ALL=C sort)

launches() { find src -name "$1" -exec cat {} + | sed -n 's/^SCREE_DEFINE_\(TEAM_\|SUM_\)\?LAUNCH\(_[A-Z_]*\)\?(\([a-z0-9_]*\)[,)].*/\3/p' | sort -u; }
comm -23 <(launches '*.c') <(launches '*.cu') | sed 's/$/: has an OpenMP loop but no grid in a .cu file/' >>"$scratch/faults"
launches '*.cu' | while read -r kernel; do
    grep -qE "\($kernel\)|, $kernel,|${kernel}_launch_cuda\(" tests/cuda_on_cpu/*.cu ||
        echo "$kernel: is launched on the device, but by no test in tests/cuda_on_cpu (see test_kernels.cu there)"
done >>"$scratch/faults"
finish "kernel headers" ${#kernels[@]} "$scratch/faults"
