"""scree bench: every benchmark runs at a tiny size, its JSON has its fields, and wrong command lines are refused."""

import json
import os
import pathlib
import statistics
import subprocess
import time

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
    options = [str(word) for word in arguments[1:]]
    assert result["options"] == options
    for case in result["cases"]:
        assert case["core_seconds"] > 0 and case["threads"] >= 1
        # what is measured once tells no noise; times that are measured again never agree to the last digit
        if case["repetitions"] > 1:
            assert case["spread"] > 0
        else:
            assert "spread" not in case
    return result


def check_bed(case, particles):
    assert case["particles"] == particles and case["steps"] == 2 and case["repetitions"] == 3
    assert case["search_every"] == 2 and case["searches_per_step"] == 0.5
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
    small, large = (result_of("packing", "--shape", shape, "--particles", str(num), "--steps", "1", "--repetitions", "1",
                               "--search-every", "1")["cases"][0]
                    for num in (20000, 100000))

    def planned(case):
        return (case["particles"] * case["bytes"]["per_particle"] + case["pairs"] * case["bytes"]["per_pair"]
                + case["contacts"] * case["bytes"]["per_contact"])

    taken = large["bytes"]["peak_resident"] - small["bytes"]["peak_resident"]
    assert 0.85 < taken / (planned(large) - planned(small)) < 1.35


def test_savings_change_the_work_and_not_the_contacts():
    cases = result_of("packing", "--shape", "schoenhardt", "--savings", *BED)["cases"]
    assert len(cases) == 8
    assert len({case["contacts"] for case in cases}) == 1
    assert all(case["times_as_long"] > 0 for case in cases[1:])
    by_name = {case["name"]: case for case in cases}
    assert by_name["schoenhardt - compare_spheres"]["pairs"] > by_name["schoenhardt"]["pairs"]
    # as many searches in each row as in the bed that it is compared with
    in_each_step = {"schoenhardt - reuse_pairs", "schoenhardt - all of these"}
    assert all(case["searches_per_step"] == (1 if case["name"] in in_each_step else 0.5) for case in cases)
    for case in cases[1:]:
        check_medians_over_turns(case)
        assert case["ratio_spread"] > 0


def check_medians_over_turns(case):
    """Times are medians of all turns and not those of the last one, and the spread is that of the turns."""
    turns = case["core_seconds_of_turns"]
    assert len(turns) == case["repetitions"] == 3
    assert case["core_seconds"] == pytest.approx(statistics.median(turns), rel=1e-4)
    assert case["spread"] == pytest.approx((max(turns) - min(turns)) / statistics.median(turns), rel=1e-3, abs=1e-4)


def test_the_automatic_skin_against_a_fixed_one():
    cases = result_of("spheres", "--savings", *BED)["cases"]
    automatic, fixed = cases[-2:]
    assert automatic["name"] == "beads falling into a drum" and fixed["name"] == "beads falling - automatic skin"
    # the same states, for no result depends on the skin, by other searches
    assert automatic["contacts"] == fixed["contacts"] and automatic["steps"] == fixed["steps"] == 20
    assert automatic["pairs"] != fixed["pairs"] or automatic["searches_per_step"] != fixed["searches_per_step"]
    assert fixed["times_as_long"] > 0 and fixed["ratio_spread"] > 0


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
    check_medians_over_turns(threads)
    check_medians_over_turns(drum)
    assert threads["times_as_long"] > 0
    ratios = [b / a for a, b in zip(bare["core_seconds_of_turns"], drum["core_seconds_of_turns"])]
    assert drum["times_as_long"] == pytest.approx(statistics.median(ratios), rel=1e-4)
    assert drum["ratio_spread"] == pytest.approx((max(ratios) - min(ratios)) / statistics.median(ratios), rel=1e-3, abs=1e-4)
    assert "times_as_long" not in bed and "times_as_long" not in bare
    run = bench("spheres", *BED, "--threads", 3)
    assert "3 threads are" in run.stdout and "on top in the drum of 200 beads" in run.stdout and not run.stderr


def test_scaling():
    cases = result_of("scaling", *BED, "--shape", "sphere", "--threads", 2)["cases"]
    assert [case["threads"] for case in cases] == [1, 2]


def check_run(case):
    """What rig and scene tell of the steps of a run."""
    assert set(case["stages"]) == STAGES
    assert case["particle_steps_per_second"] == pytest.approx(case["particles"] * case["steps"] / case["wall_seconds"], rel=1e-4)
    assert min(case["bytes"][key] for key in ("per_particle", "per_pair", "per_contact")) > 0
    stages = sum(stage["core_seconds"] for stage in case["stages"].values())
    assert 0.5 * case["core_seconds"] < stages < 1.5 * case["core_seconds"]
    assert ("core_us_per_contact_step" in case) == (case["mean_contacts"] > 0)
    if case["mean_contacts"] > 0:
        assert case["core_us_per_contact_step"] == pytest.approx(
            1e6 * case["core_seconds"] / (case["steps"] * case["mean_contacts"]), rel=1e-4)


def test_rig():
    arguments = ["rig", "--particles", 20, "--steps", 5, "--triangles", 32]
    cases = result_of(*arguments)["cases"]
    assert [case["triangles"] for case in cases] == [10, 32]
    assert all(case["steps"] == 5 and case["particles"] == 20 and case["mean_contacts"] == 0 for case in cases)
    repeated = result_of(*arguments, "--repetitions", 3)["cases"]
    for case, other in zip(cases, repeated):
        check_run(case)
        check_run(other)
        # run anew from the start: the same steps
        assert other["repetitions"] == 3
        assert [other[key] for key in ("steps", "pairs", "searches", "time")] == [case[key] for key in ("steps", "pairs", "searches", "time")]


def test_rig_tells_no_growth_of_rocks_that_touch_nothing():
    run = bench("rig", "--particles", 20, "--steps", 5, "--triangles", 32)
    assert run.returncode == 0
    assert "to the power of" not in run.stdout and "take more" in run.stdout
    # long enough for the first to fall to the floor
    run = bench("rig", "--particles", 8, "--steps", 14000, "--triangles", 32)
    assert "to the power of" in run.stdout, run.stdout


def test_overlap():
    cases = result_of("overlap", "--particles", 8, "--repetitions", 2)["cases"]
    assert [case["name"] for case in cases] == [
        "tetrahedron 4", "Schoenhardt 8", "cube 12", "sphere 40", "rock 40", "rock 100", "rock 300", "sphere 980",
        "rock 1000"]
    for case in cases:
        assert {"frame", "filter", "crossings", "sums", "result"} == set(case["stages"])
        # the overlap of two bodies that touch has an edge, and so two segments at least
        assert case["work"]["segments"] >= 2 and case["general"] > 0 and case["hierarchy"] > 0
        assert case["repetitions"] == 2


def test_scene():
    arguments = ["--scene", "scenes/gravity_packing.yaml", "--set", "particles.fall.count=20", "--steps", 7]
    cases = result_of("scene", *arguments, "--parts", 3)["cases"]
    assert [case["steps"] for case in cases] == [2, 2, 3] and cases[0]["particles"] == 20
    assert [case["name"] for case in cases] == ["to step 2", "to step 4", "to step 7"]
    repeated = result_of("scene", *arguments, "--parts", 3, "--repetitions", 2)["cases"]
    for case, other in zip(cases, repeated):
        check_run(case)
        assert [other[key] for key in ("name", "steps", "pairs", "time")] == [case[key] for key in ("name", "steps", "pairs", "time")]
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
    # another size, or the same size in other steps, cannot be compared; what to do is said
    for options in (["--particles", 100, *BED[2:]], [*BED, "--depth", "2e-3"], [*BED, "--order", "random"], [*BED, "--steps", 4]):
        other = bench("spheres", *options, "--baseline", several)
        assert other.returncode == 0 and "not in the baseline" in other.stdout
        assert "made by: scree bench spheres " + " ".join(BED) + "\n" in other.stdout
        assert "compare with the options that it was made by" in other.stdout


def test_files_are_looked_at_before_anything_is_measured(tmp_path):
    # this rig would take hours
    begin = time.monotonic()
    for path, text in ((tmp_path / "nowhere.json", None), (tmp_path / "broken.json", "{"), (tmp_path / "other.json", "{}")):
        if text is not None:
            path.write_text(text)
        run = bench("rig", "--steps", 1000000000, "--baseline", path)
        assert run.returncode != 0 and str(path) in run.stderr and "line -1" not in run.stderr and not run.stdout
    run = bench("rig", "--steps", 1000000000, "--json", tmp_path / "nowhere/result.json")
    assert run.returncode == 1 and "could not be written" in run.stderr and not run.stdout
    # a file that can be written is not made by looking
    run = bench("rig", "--steps", 1000000000, "--json", tmp_path / "result.json", "--baseline", tmp_path / "nowhere.json")
    assert run.returncode == 1 and not (tmp_path / "result.json").exists()
    assert time.monotonic() - begin < 60


def test_committed_baseline_is_readable():
    baseline = json.loads((ROOT / "benchmarks/baseline.json").read_text())
    assert {"overlap", "broad-phase", "packing", "spheres", "rig", "scaling"} == set(baseline)
    for name, result in baseline.items():
        assert result["bench"] == name and result["cases"] and result["machine"]["processor"]
        assert isinstance(result["options"], list)


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
        (["packing", "--threads"], "a value is needed after --threads"),
        (["packing", "--set", "a=b"], "packing does not take --set, which is for scene;"),
        (["packing", "--scene", "foo"], "packing does not take --scene, which is for rig, scene;"),
        (["packing", "--parts", "3"], "packing does not take --parts"),
        (["packing", "--shape", "cube", "--triangles", "40"], "--triangles is for --shape rock, not for cube"),
        (["scaling", "--triangles", "40"], "--triangles is for --shape rock, not for schoenhardt"),
        (["overlap", "--savings"], "overlap does not take --savings, which is for packing, spheres;"),
        (["overlap", "--threads", "2"], "overlap does not take --threads"),
        (["scene", "--particles", "10"], "scene does not take --particles"),
        (["rig", "--triangles", "5"], "--triangles must be at least 10"),
        (["packing", "--steps", "10"], "--search-every 10 would do"),
        (["packing", "--json", "-", "--baseline", "benchmarks/baseline.json"], "no place for the ratios"),
        (["packing", "--fast", "1"], "unknown option --fast"),
        (["packing", "spheres"], "one benchmark at a time"),
        (["rig", "--scene", "nowhere.yaml"], "nowhere.yaml"),
        (["spheres", *BED, "--baseline", "README.md"], "README.md"),
    ],
)
def test_bad_command_lines_are_refused(arguments, message):
    run = bench(*arguments)
    assert run.returncode != 0
    assert message in run.stderr
