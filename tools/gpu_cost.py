#!/usr/bin/env python3
"""What a step should cost on a GPU, from the arrays that the kernels read and write: tables for docs/theory/gpu_cost.md.

  tools/gpu_cost.py                  prints the tables
  tools/gpu_cost.py --write          puts them into the page
  tools/gpu_cost.py --achieved FILE  of a bed that scree bench packing (or spheres) --device cuda --json FILE has measured: the
                                     bytes of each stage over its time, beside a copy within the same GPU
  tools/gpu_cost.py --fits FILE N    does a bed like it of N particles fit? If not, a sentence that says so, and exit code 3
"""
import argparse
import json
import math
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "theory" / "gpu_cost.md"

# numbers of reals and of other bytes of each type
TYPES = {"real": (1, 0), "vec3": (3, 0), "quat": (4, 0), "pose": (8, 0), "int32": (0, 4), "int64": (0, 8), "uint8": (0, 1),
         "pair": (0, 8), "moving": (8, 0), "memory": (0, 8), "sphere": (4, 0), "side": (6, 0), "box": (6, 0), "node": (6, 8),
         "start": (0, 32)}  # of a record: what is read of it lies in its first sector
SECTOR = 32  # bytes, the least that a GPU moves

# Kernels of the steady step of polyhedra, one launch each. `own`: arrays at the index itself, each byte once. `far`: arrays
# of the body with the higher id, of the step before or of a row, anywhere: whole sectors. `near`: those of the body with the
# lower id; pairs are sorted by it, so they come once per particle. instructions: of the processor per index, counted.
KERNELS = [
    ("scree_predict", "particle", "src/dynamics/integrator_kernel.h",
     dict(own="mass:real force:vec3 torque:vec3 velocity:vec3*2 angular_momentum:vec3*2 position:vec3*2 orientation:quat*2 "
              "inertia:vec3 scale:real pose:pose*2 moving:real*6 shape:int32 travel:real*2"), 1204),
    ("scree_travel", "particle", "src/dynamics/neighbour_kernel.h",
     dict(own="shape:int32 pose:pose searched_pose:pose"), 164),
    ("scree_mesh_apart", "pair", "src/contact/mesh_pairs_kernel.h",
     dict(own="active:int32 first_of_pair:int32 pairs:pair memory:memory", near="travel:real", far="travel:real"), 30),
    ("scree_overlap_pairs", "contact", "src/contact/overlap_pairs_kernel.h",
     dict(own="active:int32 pairs:pair memory:memory*2", near="pose:pose shape:int32", far="pose:pose shape:int32"),
     13925),
    # only looks: at rest no gap is used up
    ("scree_mesh_gap", "pair", "src/contact/mesh_pairs_kernel.h", dict(own="memory:memory"), 6),
    ("scan of contacts", "pair", None, dict(own="first_of_pair:int32*3"), 10),
    ("scree_mesh_write", "contact", "src/contact/mesh_pairs_kernel.h",
     dict(own="kept:real*18 first_kept:int32*2 pairs:pair bodies:pair patch:int32 volume:real indentation:real radius:real "
              "normal:vec3 arm:vec3 first_of_pair:int32"), 60),
    ("scree_history_match", "pair", "src/contact/history_kernel.h",
     dict(own="first_of_pair:int32 old_first_of_pair:int32 old_of_contact:int32 is_continued:uint8*2"), 52),
    ("scree_contact_force", "contact", "src/forces/contact_force_kernel.h",
     dict(own="bodies:pair volume:real indentation:real radius:real normal:vec3 arm:vec3 old_of_contact:int32 spring_force:vec3*2 "
              "tangential_stiffness:real*2 torsion:real*2 spring_energy:real*2 elastic_energy:real*2 "
              "normal_force:vec3 tangential_force:vec3 elastic_force:real moment:vec3 elastic_work:real spring_work:real "
              "is_slipping:uint8 is_turning:uint8 sides:side*2",
          near="pose:start moving:moving",
          far="pose:start moving:moving"), 589),
    ("scree_gather", "particle", "src/forces/gather_kernel.h",
     dict(own="row_begin:int32 own_begin:int32 mass:real force:vec3 torque:vec3", far="first_of_pair:int32"), 59),
    # a row holds all candidates of a second body, touching or not; where a particle is the first one its contacts stand next to each other
    ("scree_gather, per candidate", "pair", "src/forces/gather_kernel.h", dict(own="row_pairs:int32", far="first_of_pair:int32"), 10),
    ("scree_gather, per contact", "contact", "src/forces/gather_kernel.h", dict(own="sides:side", far="sides:side"), 84),
    ("scree_correct", "particle", "src/dynamics/integrator_kernel.h",
     dict(own="mass:real force:vec3 torque:vec3 velocity:vec3*2 angular_momentum:vec3*2 inertia:vec3 orientation:quat moving:real*6"),
     185),
    ("scree_work", "contact", "src/forces/work_kernel.h",
     dict(own="bodies:pair arm:vec3 normal:vec3 elastic_force:real normal_force:vec3 tangential_force:vec3 moment:vec3 "
              "elastic_work:real spring_work:real is_slipping:uint8 is_turning:uint8 tangential_stiffness:real",
          near="own_begin:int32 first_of_pair:int32 pose:pose moving:moving inertia:vec3",
          far="pose:pose moving:moving inertia:vec3"), 456),
]

# In a bed of spheres these take the place of the kernels of meshes, and contacts act in points: nothing has moments.
SPHERE_KERNELS = [
    ("scree_place_spheres", "particle", "src/contact/sphere_pairs_kernel.h", dict(own="shape:int32 pose:pose spheres:sphere"), None),
    ("scree_sphere_sphere_count", "pair", "src/contact/sphere_pairs_kernel.h",
     dict(own="pairs:pair first_of_pair:int32", near="spheres:sphere", far="spheres:sphere"), None),
    ("scree_sphere_sphere_write", "pair", "src/contact/sphere_pairs_kernel.h", dict(own="first_of_pair:int32"), None),
    ("scree_sphere_sphere_write, per contact", "contact", "src/contact/sphere_pairs_kernel.h",
     dict(own="pairs:pair bodies:pair patch:int32 volume:real indentation:real normal:vec3 arm:vec3", near="spheres:sphere", far="spheres:sphere"),
     None),
]
NOT_IN_POINTS = {"radius", "moment", "torsion", "is_turning"}

# A search of candidate pairs, once in STEPS_PER_SEARCH: from boxes to rows, then the pairs of the narrow phase with what
# they remember. The sorts are CUB's: a pass over eight bits reads and writes everything once, and one more reads the keys.
# A leaf meets NODES nodes on its way through the tree, and BOXES leaves whose boxes it overlaps.
NODES, BOXES = 82, 15
SEARCH_KERNELS = [
    ("scree_pair_keep", "pair", "src/contact/pair_memory_kernel.h",
     dict(own="pairs:pair memory:memory*2 kept_i:int32 kept_j:int32", near="travel:real", far="travel:real"), None),
    ("scree_boxes", "particle", "src/dynamics/neighbour_kernel.h",
     dict(own="shape:int32 pose:pose boxes:box centres:vec3 radii:real"), 411),
    ("scree_lbvh_bounds", "particle", "src/bvh/lbvh_build_kernel.h", dict(own="boxes:box"), 33),
    ("scree_lbvh_codes", "particle", "src/bvh/lbvh_build_kernel.h", dict(own="boxes:box codes:int64 items:int32"), 132),
    ("sort of codes", "particle", None, dict(own="codes:int64*17 items:int32*16"), None),
    # the ends of a node are written at its split, anywhere
    ("scree_lbvh_hierarchy", "particle", "src/bvh/lbvh_build_kernel.h",
     dict(own="codes:int64", far="first_leaf:int32 last_leaf:int32"), 197),
    ("scree_lbvh_left_turns", "particle", "src/bvh/lbvh_build_kernel.h", dict(own="last_leaf:int32 num_left_turns:uint8"), 25),
    # two nodes a particle are written, one sibling is read
    ("scree_lbvh_nodes", "particle", "src/bvh/lbvh_build_kernel.h",
     dict(own="items:int32 first_leaf:int32*2 last_leaf:int32*2 num_left_turns:uint8*2 arrivals:int32*2 nodes:node*3",
          far="boxes:box"), 148),
    ("scree_particle_pairs", "particle", "src/bvh/broad_phase_kernel.h",
     dict(own="nodes:node*2 centres:vec3 radii:real", far=f"nodes:node*{NODES} centres:vec3*{BOXES} radii:real*{BOXES}"), 2149),
    ("scree_particle_pairs, per candidate", "pair", "src/bvh/broad_phase_kernel.h", dict(own="keys:int64"), None),
    ("sort of pairs", "pair", None, dict(own="keys:int64*17"), None),
    ("scree_pair_unpack", "pair", "src/bvh/broad_phase_kernel.h",
     dict(own="keys:int64 pairs:pair", near="own_begin:int32"), 36),
    ("scree_pair_second_keys", "pair", "src/bvh/broad_phase_kernel.h", dict(own="pairs:pair second_keys:int64"), None),
    ("sort by second body", "pair", None, dict(own="second_keys:int64*9"), None),
    ("scree_pair_rows", "pair", "src/bvh/broad_phase_kernel.h", dict(own="second_keys:int64 row_pairs:int32", near="row_begin:int32"), 20),
    ("copies of poses", "particle", None, dict(own="pose:pose*4 travel:real"), None),
    # once for each of four kinds of pairs
    ("scree_pair_flag", "pair", "src/contact/pair_kinds_kernel.h",
     dict(own="pairs:pair*4 places:int32*4", near="shape:int32*4", far="shape:int32*4"), 99),
    ("scan of kinds", "pair", None, dict(own="places:int32*12"), 40),
    ("scree_group_bounds", "pair", "src/contact/pair_groups_kernel.h",
     dict(own="first:int32", near="begin:int32*2 end:int32*2"), None),
    # sorted as before, so the old place is next to that of the pair before; end: and the beginning of the group; what is
    # known of the new pairs is copied to the place of the old
    ("scree_pair_carry", "pair", "src/contact/pair_memory_kernel.h",
     dict(own="pairs:pair memory:memory*3 old_memory:memory second:int32", near="end:int32*2"), None),
]
# of meshes only
FOR_MESHES = ("scree_pair_keep", "scree_group_bounds", "scree_pair_carry")

# steps of the mill of scenes/tumbling_mill_polyhedra.yaml from one search to the next while it turns
STEPS_PER_SEARCH = 17

# which kernels a stage of scree bench is made of
STAGES = {"predict": ("scree_predict",), "travel": ("scree_travel",),
          "contacts": ("scree_mesh_apart", "scree_overlap_pairs", "scree_mesh_gap", "scan of contacts", "scree_mesh_write", "scree_place_spheres",
                       "scree_sphere_sphere_count", "scree_sphere_sphere_write"),
          "history": ("scree_history_match",), "forces": ("scree_contact_force",), "gather": ("scree_gather",),
          "correct": ("scree_correct",), "work": ("scree_work",),
          "search": tuple(dict.fromkeys(name.split(",")[0] for name, *_ in SEARCH_KERNELS))}

# the packings that are predicted: candidates and touching pairs that scree bench packing and spheres have at these
# indentations, 1e-3 and 5e-3 of the size (validation/performance)
COUNTS = {"schoenhardt": {"particle": 1e6, "pair": 11.6e6, "contact": 2.6e6}, "sphere": {"particle": 1e6, "pair": 3.0e6, "contact": 2.46e6}}

# name: GB/s, multiprocessors, GHz (boost), double and single operations per multiprocessor and clock (NVIDIA's data sheets)
GPUS = {"V100 SXM2": (900, 80, 1.53, 32, 64), "A100 SXM 80 GB": (2039, 108, 1.41, 32, 64),
        "H100 SXM": (3350, 132, 1.98, 64, 128), "RTX 4090": (1008, 128, 2.52, 2, 128)}
THESIS = {"double": 72, "single": 36}  # ms on one V100, Bilock (2020), 7.1

STREAMED = 0.75  # share of the bandwidth that a copy reaches
ISSUE_STEADY = 0.5  # share of the lanes times share of the clocks in which they issue, kernels without loops
ISSUE_OVERLAP = (0.1, 0.3)  # the same of the overlap: a guess with its width
REAL_SHARE = 0.3  # of the instructions are arithmetic on reals: 0.27 to 0.32 of those of overlaps, counted


def size_of(kind, precision):
    reals, others = TYPES[kind]
    return reals * (8 if precision == "double" else 4) + others


def items(text):
    """`name:type*n` to (name, type, n)."""
    for part in text.split():
        name, kind = part.split(":")
        kind, _, num = kind.partition("*")
        yield name, kind, int(num or 1)


def sectors_of(size):
    """Sectors that a record of an array of them lies in, on average over the places where one begins."""
    step = math.gcd(size, SECTOR)
    starts = range(0, SECTOR, step)
    return sum(-(-(start + size) // SECTOR) for start in starts) / len(starts)


def bytes_of(arrays, precision, pairs_per_particle):
    """Bytes per index of a kernel."""
    total = sum(num * size_of(kind, precision) for _, kind, num in items(arrays.get("own", "")))
    total += sum(num * size_of(kind, precision) for _, kind, num in items(arrays.get("near", ""))) / pairs_per_particle
    for _, kind, num in items(arrays.get("far", "")):
        total += num * sectors_of(size_of(kind, precision)) * SECTOR
    return total


def kernels_of(name):
    """Of a step of a bed."""
    if name != "sphere":
        return KERNELS
    return SPHERE_KERNELS + [(name, per, source, without_moments(arrays), count) for name, per, source, arrays, count in KERNELS
                             if not name.startswith(("scree_mesh", "scree_overlap"))]


def search_of(name):
    return [kernel for kernel in SEARCH_KERNELS if name != "sphere" or kernel[0] not in FOR_MESHES]


def seconds_of(kernel, gpu, precision, issue_overlap, counts):
    """Whichever takes longer: memory, issuing instructions, arithmetic on reals. What was not counted is taken for memory alone."""
    name, per, _, arrays, instructions = kernel
    bandwidth, num_processors, clock, double, single = GPUS[gpu]
    issue = issue_overlap if name == "scree_overlap_pairs" else ISSUE_STEADY
    per_second = num_processors * clock * 1e9 * issue
    num = counts[per]
    instructions = instructions or 0
    return num * max(bytes_of(arrays, precision, num / counts["particle"]) / (STREAMED * bandwidth * 1e9),
                     instructions / (per_second * 128),
                     REAL_SHARE * instructions / (per_second * (double if precision == "double" else single)))


def rows_of(kernels, counts):
    """Lines of a table of kernels, the last one for all of them."""
    lines = []
    sums = {"double": 0.0, "single": 0.0, "instructions": 0.0}
    for name, per, _, arrays, instructions in kernels:
        num = counts[per]
        double, single = (bytes_of(arrays, precision, num / counts["particle"]) for precision in ("double", "single"))
        lines.append(f"| {name} | {per} | {num / 1e6:.3g}e+06 | {double:.0f} | {single:.0f} | {'' if instructions is None else instructions} | "
                     f"{double * num / 1e9:.2f} |")
        sums["double"] += double * num
        sums["single"] += single * num
        sums["instructions"] += (instructions or 0) * num
    share = {key: value / counts["particle"] for key, value in sums.items()}
    lines.append(f"| all | particle | {counts['particle'] / 1e6:.3g}e+06 | {share['double']:.0f} | {share['single']:.0f} | {share['instructions']:.0f} | "
                 f"{sums['double'] / 1e9:.2f} |")
    return lines


def table_of_kernels():
    return "\n".join(["| kernel | per | how many | bytes, double | bytes, single | instructions | GB a step, double |", "|---|---|---|---|---|---|---|"]
                     + rows_of(KERNELS, COUNTS["schoenhardt"]))


def table_of_search():
    return "\n".join(["| kernel | per | how many | bytes, double | bytes, single | instructions | GB a search, double |", "|---|---|---|---|---|---|---|"]
                     + rows_of(SEARCH_KERNELS, COUNTS["schoenhardt"]))


def milliseconds(kernels, gpu, precision, issue_overlap, counts):
    return 1e3 * sum(seconds_of(kernel, gpu, precision, issue_overlap, counts) for kernel in kernels)


def table_of_times():
    lines = ["| GPU | precision | all but overlap and search [ms] | overlap [ms] | step at rest [ms] | of a search, in a flow [ms] | Bilock (2020), V100 [ms] |",
             "|---|---|---|---|---|---|---|"]
    counts = COUNTS["schoenhardt"]
    rest, overlap = ([k for k in KERNELS if (k[0] == "scree_overlap_pairs") == is_overlap] for is_overlap in (False, True))
    for gpu in GPUS:
        for precision in ("double", "single"):
            others = milliseconds(rest, gpu, precision, 1, counts)
            low, high = (milliseconds(overlap, gpu, precision, issue, counts) for issue in reversed(ISSUE_OVERLAP))
            search = milliseconds(SEARCH_KERNELS, gpu, precision, 1, counts) / STEPS_PER_SEARCH
            lines.append(f"| {gpu} | {precision} | {others:.1f} | {low:.1f} to {high:.1f} | {others + low:.0f} to {others + high:.0f} | {search:.1f} | "
                         f"{THESIS[precision] if gpu.startswith('V100') else ''} |")
    return "\n".join(lines)


def table_of_spheres():
    lines = ["| GPU | precision | step at rest [ms] | of a search, in a flow [ms] |", "|---|---|---|---|"]
    counts = COUNTS["sphere"]
    for gpu in GPUS:
        for precision in ("double", "single"):
            step = milliseconds(kernels_of("sphere"), gpu, precision, 1, counts)
            search = milliseconds(search_of("sphere"), gpu, precision, 1, counts) / STEPS_PER_SEARCH
            lines.append(f"| {gpu} | {precision} | {step:.1f} | {search:.1f} |")
    return "\n".join(lines)


def without_moments(arrays):
    """What is left of them where contacts act in points."""
    return {where: " ".join(f"{name}:{kind}*{num}" for name, kind, num in items(text) if name not in NOT_IN_POINTS)
            for where, text in arrays.items()}


def stage_bytes(case, precision):
    """Bytes that a step of a measured bed moves in each stage, by the model."""
    num = {"particle": case["particles"], "pair": case["pairs"], "contact": case["contacts"]}
    moved = {stage: sum(bytes_of(arrays, precision, num[per] / num["particle"]) * num[per] for name, per, _, arrays, _
                        in kernels_of(case["name"]) + search_of(case["name"]) if name.split(",")[0] in names) for stage, names in STAGES.items()}
    moved["search"] *= case["searches_per_step"]
    return moved


def table_achieved(result):
    """The stages of each case of scree bench: bytes of the model over measured times, and the share of a copy's rate."""
    lines = []
    precision = result["machine"]["precision"]
    for case in result["cases"]:
        copy = case["device"]["copy_bytes_per_second"]
        moved = stage_bytes(case, precision)
        lines += [f"{case['name']}, {case['particles']} particles, {case['pairs']} pairs, {case['contacts']} contacts, {precision} precision: "
                  f"{1e3 * case['wall_seconds']:.3f} ms a step; a copy within {case['device']['name']} moves {copy / 1e9:.1f} GB/s", "",
                  "| stage | ms a step | MB of the model | GB/s | of the copy |", "|---|---|---|---|---|"]
        for stage, times in case["stages"].items():
            seconds = times["wall_seconds"]
            if not moved.get(stage) or seconds <= 0:
                lines.append(f"| {stage} | {1e3 * seconds:.3f} |  |  |  |")
                continue
            rate = moved[stage] / seconds
            share = f"{100 * rate / copy:.0f} %" if copy > 0 else "?"
            lines.append(f"| {stage} | {1e3 * seconds:.3f} | {moved[stage] / 1e6:.1f} | {rate / 1e9:.1f} | {share} |")
        lines.append("")
    return "\n".join(lines)


def free_on_the_host():
    """[bytes] that programs can have, or None."""
    found = re.search(r"^MemAvailable: +(\d+) kB", Path("/proc/meminfo").read_text(), re.MULTILINE) if Path("/proc/meminfo").exists() else None
    return 1024 * int(found[1]) if found else None


def what_lacks(result, particles, host=None):
    """A sentence why a bed of so many particles would not fit, by what one like it took; None if it would."""
    case = result["cases"][0]
    times = particles / case["particles"]
    for place, taken, free in (("the GPU", case["device"]["scene_bytes"], case["device"]["free_bytes"]),
                               ("this machine", case["bytes"]["peak_resident"], host)):
        if free is not None and times * taken > free:
            return (f"{case['name']}, {particles} particles, {result['machine']['precision']} precision: left out, {place} has {free / 1e9:.1f} GB of free "
                    f"memory and the bed would take about {times * taken / 1e9:.1f} GB")
    return None


def with_tables(page):
    for name, table in (("kernels", table_of_kernels()), ("search", table_of_search()), ("times", table_of_times()),
                        ("spheres", table_of_spheres())):
        page, num = re.subn(rf"(<!-- {name} -->\n).*?(<!-- end -->)", lambda m: m[1] + table + "\n" + m[2], page, flags=re.DOTALL)
        if num != 1:
            raise SystemExit(f"{PAGE} has no place for the table of {name}")
    return page


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--write", action="store_true", help="puts the tables into the page")
    parser.add_argument("--achieved", metavar="FILE", type=Path, help="holds a measured bed against the model")
    parser.add_argument("--fits", metavar=("FILE", "N"), nargs=2, help="does a bed like this of N particles fit?")
    asked = parser.parse_args()
    if asked.write:
        PAGE.write_text(with_tables(PAGE.read_text()))
    elif asked.achieved:
        print(table_achieved(json.loads(asked.achieved.read_text())))
    elif asked.fits:
        lack = what_lacks(json.loads(Path(asked.fits[0]).read_text()), int(asked.fits[1]), free_on_the_host())
        if lack:
            print(lack)
            sys.exit(3)
    else:
        print(table_of_kernels(), table_of_search(), table_of_times(), table_of_spheres(), sep="\n\n")


if __name__ == "__main__":
    main()
