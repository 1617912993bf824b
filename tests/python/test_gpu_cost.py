"""The model of the cost on a GPU names the arrays that the kernels have, and its page has the tables that it gives."""

import os
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(os.environ.get("SCREE_SOURCE_DIR", Path(__file__).parents[2]))
sys.path.insert(0, str(ROOT / "tools"))
import gpu_cost  # noqa: E402

FROM_SOURCES = [kernel for kernel in gpu_cost.KERNELS + gpu_cost.SEARCH_KERNELS if kernel[2]]
OF_SPHERES = gpu_cost.SPHERE_KERNELS


def named(kernel):
    return {name for text in kernel[3].values() for name, _, _ in gpu_cost.items(text)}


@pytest.mark.parametrize("kernel", FROM_SOURCES + OF_SPHERES, ids=[kernel[0] for kernel in FROM_SOURCES + OF_SPHERES])
def test_arrays_of_the_model_are_in_the_source(kernel):
    words = set(re.findall(r"\w+", (ROOT / kernel[2]).read_text()))
    name = kernel[0].split(",")[0]
    assert {name + "_at", name + "_team_at"} & words
    assert named(kernel) <= words, f"{kernel[2]} does not know {sorted(named(kernel) - words)}"


@pytest.mark.parametrize("source", sorted({kernel[2] for kernel in FROM_SOURCES}))
def test_arrays_of_the_source_are_in_the_model(source):
    # whatever is indexed behind the argument of a kernel
    text = (ROOT / source).read_text()
    used = set(re.findall(r"\ba(?:->|\.)(?:\w+\.)?(\w+)\[", text))
    known = set().union(*(named(kernel) for kernel in FROM_SOURCES if kernel[2] == source))
    # in neither a step of polyhedra nor a search: batches where all pairs are of one kind, patches are those of several contacts of a pair, walls few, sums and bounds of chunks
    # one per 256 contacts and in all, area and torque vectors are for one force law, shapes for gaps that are used up and where pairs are told apart by their work, rolling moments for rolling resistance
    elsewhere = {"batch", "walls", "chunk_bounds", "pairs", "patch", "arm", "old_patch", "old_arm", "old_bodies", "sums",
                 "area_vector", "torque_vector", "kept_levers", "shape", "shapes", "rolling_moment", "slices", "laws"}
    elsewhere |= {"ids", "places", "own_before"}  # of particles that have changed places
    if source.endswith("gather_kernel.h"):
        elsewhere |= {"bodies", "normal_force", "tangential_force", "moment", "pose"}  # only where the forces leave no sides: on the CPU
    if source.endswith("pair_groups_kernel.h"):
        elsewhere |= {"second"}  # looked up by scree_pair_carry, which has it
    assert used - known <= elsewhere, f"{source} also uses {sorted(used - known - elsewhere)}: put them into tools/gpu_cost.py"


def test_contacts_in_points_have_no_moments():
    header = (ROOT / "src" / "contact" / "contact_list.h").read_text()
    untouched = set(re.findall(r"\*(\w+); +///< (?:\+ )?\*", header))
    not_in_model = {"area_vector", "torque_vector", "rolling_moment"}
    assert not_in_model < untouched
    assert gpu_cost.NOT_IN_POINTS == untouched - not_in_model


def measured(**case):
    stages = {name: {"wall_seconds": 1e-3} for name in ("predict", "search", "gather", "other")}
    return {"machine": {"precision": "double"},
            "cases": [dict({"name": "schoenhardt", "particles": 1000, "pairs": 8000, "contacts": 4000, "wall_seconds": 4e-3, "stages": stages,
                       "searches_per_step": 0.05,
                            "bytes": {"peak_resident": 10_000_000},
                            "device": {"name": "some GPU", "copy_bytes_per_second": 2e9, "scene_bytes": 1_000_000, "free_bytes": 9_000_000}}, **case)]}


def test_sectors():
    # a vector of doubles begins at 0, 8, 16 or 24 of a sector; one cache line is two
    assert [gpu_cost.sectors_of(size) for size in (8, 24, 32, 48, 64)] == [1, 1.5, 1, 2, 2]
    assert gpu_cost.sectors_of(12) == (6 * 1 + 2 * 2) / 8


def test_achieved_is_bytes_over_time():
    rows = dict(re.findall(r"^\| (\w+) \| 1.000 \|(.*)\|$", gpu_cost.table_achieved(measured()), re.MULTILINE))
    # 492 bytes of each of a thousand in a millisecond, a quarter of what a copy moves; gathering by particle, by candidate and by contact
    assert rows["predict"].split(" | ") == [" 0.5", "0.5", "25 % "]
    assert rows["gather"].split(" | ")[0] == f" {(100 * 1000 + 36 * 8000 + 112 * 4000) / 1e6:.1f}"
    assert not rows["other"].replace("|", "").strip() and float(rows["search"].split(" | ")[0]) > 0
    # nothing is known of a bed that was never searched
    rows = dict(re.findall(r"^\| (\w+) \| 1.000 \|(.*)\|$", gpu_cost.table_achieved(measured(searches_per_step=0)), re.MULTILINE))
    assert not rows["search"].replace("|", "").strip()


def test_searches_are_shared_by_their_steps():
    often, seldom = (gpu_cost.stage_bytes(measured(searches_per_step=share)["cases"][0], "double")["search"] for share in (1, 0.125))
    assert often == 8 * seldom > 0
    # a particle's box, its share of the keys' passes, and 8 bytes of each pair's key go through it
    assert often > 1000 * (48 * 3 + 17 * 8) + 8000 * 26 * 8
    # spheres remember nothing of a pair
    sphere = gpu_cost.stage_bytes(measured(searches_per_step=1, name="sphere")["cases"][0], "double")["search"]
    memory = [kernel for kernel in gpu_cost.SEARCH_KERNELS if kernel[0] in gpu_cost.FOR_MESHES]
    assert len(memory) == 3 and often - sphere == pytest.approx(sum(8000 * gpu_cost.bytes_of(kernel[3], "double", 8) for kernel in memory))


def test_passes_of_the_sorts():
    # one over each 8 of the bits of a key that are sorted by, and one that reads; src/bvh/broad_phase.c sorts by all and by the upper 32
    arrays = {kernel[0]: dict((name, num) for name, _, num in gpu_cost.items(kernel[3]["own"])) for kernel in gpu_cost.SEARCH_KERNELS
              if kernel[0].startswith("sort")}
    assert arrays == {"sort of codes": {"codes": 17, "items": 16}, "sort of pairs": {"keys": 17}, "sort by second body": {"second_keys": 9}}
    source = (ROOT / "src" / "bvh" / "broad_phase.c").read_text()
    assert re.findall(r"scree_sort\(.*, (\d+)\);", source) == ["32", "0"]


def test_every_kernel_of_the_model_is_in_one_stage():
    for kernels in (gpu_cost.KERNELS, gpu_cost.SEARCH_KERNELS, OF_SPHERES):
        for kernel in kernels:
            assert sum(kernel[0].split(",")[0] in names for names in gpu_cost.STAGES.values()) == 1, kernel[0]


def test_spheres_move_less_than_meshes():
    mesh, sphere = (gpu_cost.stage_bytes(measured(name=name)["cases"][0], "double") for name in ("schoenhardt", "sphere"))
    # a contact of points: neither moment nor radius; two torsions of the history, and the mark
    assert mesh["forces"] - sphere["forces"] == 4000 * (8 + 24 + 2 * 8 + 1)
    assert mesh["gather"] == sphere["gather"] and mesh["predict"] == sphere["predict"]
    assert sphere["contacts"] < mesh["contacts"]


def test_what_does_not_fit_is_told():
    assert gpu_cost.what_lacks(measured(), 9000, 90_000_000) is None
    assert "9001 particles" in gpu_cost.what_lacks(measured(), 9001) and "the GPU has 0.0 GB" in gpu_cost.what_lacks(measured(), 9001)
    assert "this machine has" in gpu_cost.what_lacks(measured(), 9000, 89_000_000)


def test_page_has_the_tables():
    page = gpu_cost.PAGE.read_text()
    assert gpu_cost.with_tables(page) == page, "run tools/gpu_cost.py --write"


def test_bytes_of_a_streamed_and_of_a_far_record():
    assert gpu_cost.bytes_of({"own": "a:vec3*2 b:int32"}, "double", 1) == 52
    assert gpu_cost.bytes_of({"near": "a:pose"}, "single", 4) == 8
    # 24 bytes that begin at a multiple of 8 touch one sector in two places of four and two in the others
    assert gpu_cost.bytes_of({"far": "a:vec3"}, "double", 1) == 48
