#!/usr/bin/env bash
# In both precisions, every .cu file compiles without warnings for the three architectures, and its PTX holds no multiply-add
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
    local kind=$1 file=$2 real= out
    [[ $kind != float* ]] || real=-DSCREE_SINGLE=1
    out=$scratch/$(echo "$kind $file" | tr ' /' '__')
    case $kind in
    double | float)
        "$nvcc" $flags $real -Xptxas=-v -gencode arch=compute_80,code=sm_80 -gencode arch=compute_90,code=sm_90 \
            -gencode arch=compute_120,code=sm_120 -c "$file" -o "$out.o"
        ;;
    double_ptx | float_ptx)
        "$nvcc" $flags $real -arch=sm_80 -rdc=true -include tests/checks/mark_fma.h --ptx "$file" -o "$out.ptx" &&
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
for real in 64 32; do
    "$nvcc" ${flags/--fmad=false/} $([ $real = 64 ] || echo -DSCREE_SINGLE=1) -arch=sm_80 --ptx src/forces/forces_cuda.cu \
        -o "$scratch/probe.ptx" && grep "fma\.rn\.f$real" "$scratch/probe.ptx" >/dev/null ||
        { echo "with contraction on, no fma of $real bits is found in the PTX: the check sees nothing"; exit 1; }
done

{
    for kind in double float double_ptx float_ptx; do printf "$kind %s\n" "${units[@]}"; done
    printf 'header %s\n' "${headers[@]}"
    printf 'test %s\n' "${emulated[@]}"
} | xargs -P 2 -L 1 bash -c 'job "$@"' job
cat "$scratch"/*.fault >"$scratch/faults" 2>/dev/null
PATH=$PATH:$(dirname "$nvcc")
python3 -B tests/checks/cuda_resources.py "$@" "$scratch"/{double,float}_src_*.log >>"$scratch/faults" 2>&1
finish "CUDA files and kernel headers" $((${#units[@]} + ${#headers[@]})) "$scratch/faults"
