"""The model of the cost on a GPU names the arrays that the kernels have, and its page has the tables that it gives."""

import os
import re
import sys
from pathlib import Path

import pytest

ROOT = Path(os.environ.get("SCREE_SOURCE_DIR", Path(__file__).parents[2]))
sys.path.insert(0, str(ROOT / "tools"))
import gpu_cost  # noqa: E402

FROM_SOURCES = [kernel for kernel in gpu_cost.KERNELS if kernel[2]]


def named(kernel):
    return {name for text in kernel[3].values() for name, _, _ in gpu_cost.items(text)}


@pytest.mark.parametrize("kernel", FROM_SOURCES, ids=[kernel[0] for kernel in FROM_SOURCES])
def test_arrays_of_the_model_are_in_the_source(kernel):
    words = set(re.findall(r"\w+", (ROOT / kernel[2]).read_text()))
    assert kernel[0].split(",")[0] + "_at" in words
    assert named(kernel) <= words, f"{kernel[2]} does not know {sorted(named(kernel) - words)}"


@pytest.mark.parametrize("source", sorted({kernel[2] for kernel in FROM_SOURCES}))
def test_arrays_of_the_source_are_in_the_model(source):
    # whatever is indexed behind the argument of a kernel
    text = (ROOT / source).read_text()
    used = set(re.findall(r"\ba(?:->|\.)(?:\w+\.)?(\w+)\[", text))
    known = set().union(*(named(kernel) for kernel in FROM_SOURCES if kernel[2] == source))
    # not of the steady step of polyhedra: boxes are the search's, patches those of several contacts of a pair, sums are
    # one per 256 contacts, and area and torque vectors are for one force law
    elsewhere = {"boxes", "centres", "radii", "pairs", "patch", "arm", "old_patch", "old_arm", "old_bodies", "sums",
                 "area_vector", "torque_vector", "slices", "laws"}
    assert used - known <= elsewhere, f"{source} also uses {sorted(used - known - elsewhere)}: put them into tools/gpu_cost.py"


def test_page_has_the_tables():
    page = gpu_cost.PAGE.read_text()
    assert gpu_cost.with_tables(page) == page, "run tools/gpu_cost.py --write"


def test_bytes_of_a_streamed_and_of_a_far_record():
    assert gpu_cost.bytes_of({"own": "a:vec3*2 b:int32"}, "double", 1) == 52
    assert gpu_cost.bytes_of({"near": "a:pose"}, "single", 4) == 8
    # 24 bytes that begin at a multiple of 8 touch one sector in two places of four and two in the others
    assert gpu_cost.bytes_of({"far": "a:vec3"}, "double", 1) == 48
