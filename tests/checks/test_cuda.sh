#!/usr/bin/env bash
# Every .cu file compiles without warnings for the three architectures, in both precisions; the PTX holds no multiply-add
# but those written as fma(); every kernel header compiles alone as CUDA. Nothing is run: that needs a device. The tests of
# the stand-in for a device, tests/cuda_on_cpu, compile too: what it offers is what CUDA has. What the kernels take is that
# of docs/cuda_resources.md, without stack and spills where nothing else is said; --write writes this page.
. "$(dirname "$0")/common.sh"
nvcc=$(command -v nvcc || ls /usr/local/cuda/bin/nvcc 2>/dev/null) || { echo "skipped: there is no nvcc"; exit 77; }
flags="-std=c++17 --fmad=false --ftz=false --prec-div=true --prec-sqrt=true -Werror=all-warnings"
flags="$flags -Xcompiler=-Wall,-ffp-contract=off -Iinclude -Isrc"
export nvcc flags scratch
mapfile -t units < <(find src -name '*.cu' | LC_ALL=C sort)
mapfile -t emulated < <(find tests/cuda_on_cpu -name 'test_*.cu' | LC_ALL=C sort)
mapfile -t headers < <(find src -name '*_kernel.h' | LC_ALL=C sort)

# One job a line: KIND FILE. Faults go to a file of their own, since two jobs run at a time.
job() {
    local kind=$1 file=$2 out
    out=$scratch/$(echo "$kind $file" | tr ' /' '__')
    case $kind in
    double | float)
        local real=
        [ "$kind" = float ] && real=-DSCREE_SINGLE=1
        "$nvcc" $flags $real -Xptxas=-v -gencode arch=compute_80,code=sm_80 -gencode arch=compute_90,code=sm_90 \
            -gencode arch=compute_120,code=sm_120 -c "$file" -o "$out.o"
        ;;
    ptx)
        "$nvcc" $flags -arch=sm_80 -rdc=true -include tests/checks/mark_fma.h --ptx "$file" -o "$out.ptx" &&
            ! grep -nE '^[[:space:]]*(fma|mad)\.[a-z.]*f(32|64)' "$out.ptx"
        ;;
    test)
        "$nvcc" $flags -Itests -Itests/cuda_on_cpu -arch=sm_80 -c "$file" -o "$out.o"
        ;;
    header)
        printf '#include "%s"\n' "${file#src/}" >"$out.cu"
        "$nvcc" $flags -diag-suppress 177 -arch=sm_80 --ptx "$out.cu" -o "$out.ptx"
        ;;
    esac >"$out.log" 2>&1 || { echo "$file: fails as $kind with $nvcc"; head -n 20 "$out.log"; } >"$out.fault"
}
export -f job

# that the check of the PTX can fail: with contraction on, there is something to find
"$nvcc" ${flags/--fmad=false/} -arch=sm_80 --ptx src/forces/forces_cuda.cu -o "$scratch/probe.ptx" &&
    grep -E 'fma\.rn\.f64' "$scratch/probe.ptx" >/dev/null ||
    { echo "with contraction on, no fma is found in the PTX: the check sees nothing"; exit 1; }

{
    printf 'double %s\n' "${units[@]}"
    printf 'float %s\n' "${units[@]}"
    printf 'ptx %s\n' "${units[@]}"
    printf 'header %s\n' "${headers[@]}"
    printf 'test %s\n' "${emulated[@]}"
} | xargs -P 2 -L 1 bash -c 'job "$@"' job
cat "$scratch"/*.fault >"$scratch/faults" 2>/dev/null
PATH=$PATH:$(dirname "$nvcc")
python3 -B tests/checks/cuda_resources.py "$@" "$scratch"/double_*.log >>"$scratch/faults" 2>&1
finish "CUDA files and kernel headers" $((${#units[@]} + ${#headers[@]})) "$scratch/faults"
