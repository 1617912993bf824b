"""scree bench: every benchmark runs at a tiny size, its JSON has its fields, and wrong command lines are refused."""

import json
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(os.environ.get("SCREE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
PROGRAM = os.environ.get("SCREE_PROGRAM", str(ROOT / "build/release/scree"))

STAGES = {"predict", "travel", "search", "contacts", "history", "forces", "gather", "correct", "work", "other"}
BED = ["--particles", "64", "--steps", "2", "--repetitions", "3", "--search-every", "2"]


def bench(*arguments):
    return subprocess.run([PROGRAM, "bench", *map(str, arguments)], capture_output=True, text=True, cwd=ROOT)


def result_of(*arguments):
    run = bench(*arguments, "--json", "-")
    assert run.returncode == 0, run.stderr
    result = json.loads(run.stdout)
    assert result["bench"] == arguments[0] and result["version"]
    assert {"processor", "processors", "compiler", "precision"} == set(result["machine"])
    for case in result["cases"]:
        assert case["core_seconds"] > 0 and case["spread"] >= 0 and case["threads"] >= 1
    return result


def check_bed(case, particles):
    assert case["particles"] == particles and case["steps"] == 2 and case["repetitions"] == 3
    assert set(case["stages"]) == STAGES
    # the stages make up the step: nothing is left out, nothing counted twice
    stages = sum(stage["core_seconds"] for stage in case["stages"].values())
    assert 0.5 * case["core_seconds"] < stages < 1.5 * case["core_seconds"]
    assert case["stages"]["contacts"]["core_seconds"] > 0 and case["stages"]["search"]["core_seconds"] > 0
    assert case["core_us_per_contact"] == pytest.approx(1e6 * case["core_seconds"] / case["contacts"], rel=1e-4)
    assert case["core_ns_per_pair"] == pytest.approx(1e9 * case["core_seconds"] / case["pairs"], rel=1e-4)
    assert case["particle_steps_per_second"] == pytest.approx(particles / case["wall_seconds"], rel=1e-4)
    assert {"per_particle", "per_pair", "per_contact", "allocated", "peak_resident"} == set(case["bytes"])
    assert min(case["bytes"].values()) > 0
    assert case["pairs"] >= case["contacts"] > particles / 4


def test_packing():
    cases = result_of("packing", *BED)["cases"]
    assert [case["name"] for case in cases] == ["cube", "schoenhardt", "rock 28", "rock 40", "sphere"]
    for case in cases:
        check_bed(case, 64)
        wanted = 5e-3 if case["name"] == "sphere" else 1e-3
        assert 0.3 * wanted < case["mean_depth"] <= 1.2 * wanted


@pytest.mark.parametrize("shape", ["cube", "sphere"])
def test_memory_is_that_of_the_plan(shape):
    # of two beds, so that what the program takes by itself does not count; arrays grow ahead by up to a quarter
    small, large = (result_of("packing", "--shape", shape, "--particles", str(num), "--steps", "1", "--repetitions", "1")["cases"][0]
                    for num in (20000, 100000))

    def planned(case):
        return (case["particles"] * case["bytes"]["per_particle"] + case["pairs"] * case["bytes"]["per_pair"]
                + case["contacts"] * case["bytes"]["per_contact"])

    taken = large["bytes"]["peak_resident"] - small["bytes"]["peak_resident"]
    assert 0.85 < taken / (planned(large) - planned(small)) < 1.35


def test_savings_change_the_work_and_not_the_contacts():
    cases = result_of("packing", "--shape", "schoenhardt", "--savings", *BED)["cases"]
    assert len(cases) == 7
    assert len({case["contacts"] for case in cases}) == 1
    assert all(case["times_as_long"] > 0 for case in cases[1:])
    by_name = {case["name"]: case for case in cases}
    assert by_name["schoenhardt - compare_spheres"]["pairs"] > by_name["schoenhardt"]["pairs"]
    assert by_name["schoenhardt"]["searches_per_step"] == pytest.approx(0.5, abs=0.34)
    assert by_name["schoenhardt - reuse_pairs"]["searches_per_step"] >= 1


@pytest.mark.parametrize("order", ["morton", "random"])
def test_order_changes_no_contact(order):
    lattice, other = (result_of("spheres", *BED, "--order", name)["cases"][0] for name in ("lattice", order))
    check_bed(other, 64)
    assert other["contacts"] == lattice["contacts"]


def test_spheres_on_threads_and_in_a_drum():
    cases = result_of("spheres", *BED)["cases"]
    assert [case["name"] for case in cases] == [
        "sphere", "sphere, 2 threads in turn with one", "beads of a drum, no walls", "beads in a drum of meshes"]
    assert [case["threads"] for case in cases] == [1, 2, 1, 1]
    bed, threads, bare, drum = cases
    # the same bed; the same beads, which touch walls besides each other: the shell below them and both ends
    assert threads["contacts"] == bed["contacts"] and threads["pairs"] == bed["pairs"]
    assert bare["particles"] == drum["particles"] == 200
    assert bare["contacts"] + 20 < drum["contacts"] < 2 * bare["contacts"]
    assert threads["times_as_long"] > 0 and drum["times_as_long"] > 0
    assert "times_as_long" not in bed and "times_as_long" not in bare
    run = bench("spheres", *BED, "--threads", 3)
    assert "3 threads are" in run.stdout and "on top in the drum of 200 beads" in run.stdout and not run.stderr


def test_scaling():
    cases = result_of("scaling", *BED, "--shape", "sphere", "--threads", 2)["cases"]
    assert [case["threads"] for case in cases] == [1, 2]


def test_rig():
    cases = result_of("rig", "--particles", 20, "--steps", 5, "--triangles", 32)["cases"]
    assert [case["triangles"] for case in cases] == [10, 32]
    assert all(case["steps"] == 5 and case["particles"] == 20 and set(case["stages"]) == STAGES for case in cases)


def test_overlap():
    cases = result_of("overlap", "--particles", 8, "--repetitions", 2)["cases"]
    assert [case["name"] for case in cases] == [
        "tetrahedron 4", "Schoenhardt 8", "cube 12", "sphere 40", "rock 40", "rock 100", "rock 300", "sphere 980",
        "rock 1000"]
    for case in cases:
        assert {"frame", "filter", "crossings", "sums", "result"} == set(case["stages"])
        # the overlap of two bodies that touch has an edge, and so two segments at least
        assert case["work"]["segments"] >= 2 and case["general"] > 0 and case["hierarchy"] > 0


def test_scene():
    arguments = ["--scene", "scenes/gravity_packing.yaml", "--set", "particles.fall.count=20", "--steps", 7]
    cases = result_of("scene", *arguments, "--parts", 3)["cases"]
    assert [case["steps"] for case in cases] == [2, 2, 3] and cases[0]["particles"] == 20
    assert [case["name"] for case in cases] == ["to step 2", "to step 4", "to step 7"]
    assert bench("scene", *arguments, "--set", "particles.fall.count=-1").returncode == 2


def test_broad_phase():
    cases = result_of("broad-phase", "--particles", 1000, "--repetitions", 2)["cases"]
    assert [case["name"] for case in cases] == ["size 1:2", "size 1:1000", "elongation 1:50"]
    for case in cases:
        assert {"build", "refit", "search", "plain_search", "sort_and_rows"} == set(case["stages"])
        assert case["pairs"] > 0 and case["core_ns_per_pair"] > 0


def test_tables_and_baseline(tmp_path):
    arguments = ["spheres", *BED]
    first = bench(*arguments, "--json", tmp_path / "first.json")
    assert first.returncode == 0 and "touch/p" in first.stdout and "sphere" in first.stdout
    second = bench(*arguments, "--baseline", tmp_path / "first.json")
    assert second.returncode == 0 and "of the baseline" in second.stdout
    several = tmp_path / "several.json"
    several.write_text(json.dumps({"spheres": json.loads((tmp_path / "first.json").read_text())}))
    assert "of the baseline" in bench(*arguments, "--baseline", several).stdout
    other = bench(*arguments[:1], "--particles", 100, *BED[2:], "--baseline", several)
    assert other.returncode == 0 and "not in the baseline" in other.stdout



def test_committed_baseline_is_readable():
    baseline = json.loads((ROOT / "benchmarks/baseline.json").read_text())
    assert {"overlap", "broad-phase", "packing", "spheres", "rig", "scaling"} == set(baseline)
    for name, result in baseline.items():
        assert result["bench"] == name and result["cases"] and result["machine"]["processor"]


@pytest.mark.parametrize(
    "arguments, message",
    [
        ([], "no benchmark given"),
        (["pakcing"], 'did you mean "packing"'),
        (["packing", "--shape", "ball"], "cube, schoenhardt, rock or sphere"),
        (["packing", "--order", "sorted"], "lattice, morton or random"),
        (["packing", "--particles", "1e4"], "whole number from 8 to"),
        (["packing", "--steps", "0"], "whole number from 1 to"),
        (["packing", "--depth", "0"], "--depth must be a number"),
        (["packing", "--threads"], "needs a value"),
        (["packing", "--fast", "1"], "unknown option --fast"),
        (["packing", "spheres"], "one benchmark at a time"),
        (["rig", "--scene", "nowhere.yaml"], "nowhere.yaml"),
        (["spheres", *BED, "--baseline", "README.md"], "README.md"),
        (["spheres", *BED, "--json", "/nowhere/result.json"], "could not be written"),
    ],
)
def test_bad_command_lines_are_refused(arguments, message):
    run = bench(*arguments)
    assert run.returncode != 0
    assert message in run.stderr
