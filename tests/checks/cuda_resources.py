"""Registers, stack, spills, shared memory and occupancy of every kernel, from the words of `ptxas -v`, as the tables of
docs/cuda_resources.md, one for each precision.

usage: cuda_resources.py [--write] LOG...

Names of logs begin with their precision, double_ or float_. Fails if a kernel has a stack frame or spills without a
reason below, if such a reason is no longer needed, or if the tables are not those of these logs; --write writes them
instead.
"""
import re
import subprocess
import sys
from pathlib import Path

TABLE = Path(__file__).resolve().parents[2] / "docs" / "cuda_resources.md"
BLOCK_WARPS = 4  # SCREE_CUDA_BLOCK

# warps and blocks that a multiprocessor can hold (CUDA C++ Programming Guide, compute capabilities); each has
# 65536 registers, given to warps in units of 256
LIMITS = {"80": (64, 32), "90": (64, 32), "120": (48, 24)}

PRECISIONS = {"double": "Double precision", "float": "Single precision"}

# kernels that may have a frame or spills in both precisions, and why
REASONS = {}

# the same in one precision only
REASONS_IN = {
    "double": {
        "scree_overlap_patches": "a whole overlap by a team of lanes, with all registers there are; telling patches apart, by one lane, "
        "sums over the edges of each tree of corners anew; only where a scene asks for patches",
    },
    "float": {},
}

HEAD = """# What the kernels take on a GPU

Made by `tests/checks/test_cuda.sh --write` from the words of `ptxas -v` ({compiler}, blocks of {block} threads). Three
numbers are for compute capabilities 8.0, 9.0 and 12.0, one stands for all. Registers per thread; stack and spilt bytes
(stores + loads) per thread; shared memory per block; occupancy: the warps that a multiprocessor holds at a time, of those
it could hold, as far as registers decide. Nothing here was timed.

No kernel may have a stack frame or spills, unless its table says why.
"""

TABLE_HEAD = """
## {precision}

| kernel | registers | stack | spills | shared | occupancy | |
|---|---|---|---|---|---|---|
"""


def reasons_in(precision):
    return {**REASONS, **REASONS_IN[precision]}


def read_logs(paths):
    """{kernel: {architecture: {"stack", "spills", "registers", "shared"}}}"""
    kernels = {}
    entry = None
    for path in paths:
        for line in path.read_text().splitlines():
            found = re.search(r"Compiling entry function '\w*?\d(scree_[a-z0-9_]+?)_grid\w*' for 'sm_(\d+)'", line)
            if found:
                entry = kernels.setdefault(found[1], {}).setdefault(found[2], {})
            found = re.search(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads", line)
            if found and entry is not None and "stack" not in entry:
                entry["stack"] = int(found[1])
                entry["spills"] = int(found[2]) + int(found[3])
            found = re.search(r"Used (\d+) registers", line)
            if found and entry is not None:
                entry["registers"] = int(found[1])
                shared = re.search(r"(\d+) bytes smem", line)
                entry["shared"] = int(shared[1]) if shared else 0
                entry = None
    return kernels


def occupancy(architecture, registers):
    """In percent."""
    max_warps, max_blocks = LIMITS[architecture]
    per_warp = (registers * 32 + 255) // 256 * 256
    blocks = min(65536 // per_warp // BLOCK_WARPS, max_warps // BLOCK_WARPS, max_blocks)
    return round(100 * blocks * BLOCK_WARPS / max_warps)


def column(by_architecture, value):
    texts = [str(value(a, by_architecture[a])) for a in LIMITS]
    return texts[0] if len(set(texts)) == 1 else " / ".join(texts)


def make_head():
    words = subprocess.run(["nvcc", "--version"], capture_output=True, text=True, check=False).stdout
    release = re.search(r"release ([0-9.]+)", words)
    return HEAD.format(compiler="nvcc " + (release[1] if release else "of unknown release"), block=32 * BLOCK_WARPS)


def make_table(precision, kernels):
    text = TABLE_HEAD.format(precision=PRECISIONS[precision])
    for kernel in sorted(kernels):
        k = kernels[kernel]
        text += "| `{}` | {} | {} | {} | {} | {} | {} |\n".format(
            kernel,
            column(k, lambda a, e: e["registers"]),
            column(k, lambda a, e: e["stack"]),
            column(k, lambda a, e: e["spills"]),
            column(k, lambda a, e: e["shared"]),
            column(k, lambda a, e: f"{occupancy(a, e['registers'])} %"),
            reasons_in(precision).get(kernel, ""),
        )
    return text


def find_faults(precision, kernels):
    faults = []
    reasons = reasons_in(precision)
    for kernel, by_architecture in sorted(kernels.items()):
        if set(by_architecture) != set(LIMITS) or any("registers" not in e for e in by_architecture.values()):
            faults.append(f"{kernel}, {precision}: the words of ptxas are not complete: {by_architecture}")
            continue
        has_frame = any(e["stack"] or e["spills"] for e in by_architecture.values())
        if has_frame and kernel not in reasons:
            faults.append(
                f"{kernel}, {precision}: has {column(by_architecture, lambda a, e: e['stack'])} bytes of stack and spills "
                f"{column(by_architecture, lambda a, e: e['spills'])}; give it fewer variables, or a reason in {__file__}"
            )
        if not has_frame and kernel in reasons:
            faults.append(f"{kernel}, {precision}: has neither stack nor spills, so its reason in {__file__} can go")
    faults += [f"{kernel}, {precision}: has a reason in {__file__}, but is not there" for kernel in reasons if kernel not in kernels]
    return faults


def main(arguments):
    is_write = "--write" in arguments
    paths = [Path(a) for a in arguments if a != "--write"]
    page = make_head()
    faults = []
    for precision in PRECISIONS:
        kernels = read_logs([path for path in paths if path.name.startswith(precision + "_")])
        if not kernels:
            return [f"no kernels of {precision} in the words of ptxas"]
        faults += find_faults(precision, kernels)
        if any("not complete" in fault for fault in faults):
            return faults
        page += make_table(precision, kernels)
    if is_write:
        TABLE.write_text(page)
    elif not TABLE.exists() or TABLE.read_text() != page:
        faults.append(f"{TABLE}: is not that of these kernels; run tests/checks/test_cuda.sh --write")
    return faults


if __name__ == "__main__":
    found = main(sys.argv[1:])
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
