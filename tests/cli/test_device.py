"""scree run --device cuda, on the emulated device of tests/cuda_on_cpu: the results of the CPU, and what happens on machines
with faults.

SCREE_BUILD_DIR holds the program (scree) and the one with the emulated device (scree_emulated).
"""

import csv
import json
import os
import re
import subprocess
from pathlib import Path

import pytest

from terminal import on_terminal

ROOT = Path(os.environ.get("SCREE_SOURCE_DIR", Path(__file__).parents[2]))
BUILD = Path(os.environ.get("SCREE_BUILD_DIR", ROOT / "build/release")).resolve()
EMULATED = BUILD / "scree_emulated"
pytestmark = pytest.mark.skipif(not EMULATED.exists(), reason=f"there is no {EMULATED}")

SCENE = """
name: on the device
gravity: [0, 0, -300]
time: {end: 0.012, step: 2e-5}
materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]
contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, restitution_coefficient: 0.4}]
shapes:
  - {name: rock, source: rock, triangles: 20, seed: 3}
  - {name: ball, source: sphere, size: 0.01}
  - {name: floor, source: box, size: [0.2, 0.2, 0.02]}
particles:
  - {name: rocks, shape: rock, material: stone, count: 12, seed: 1, size: {distribution: fixed, mean: 0.01},
     velocity: [0, 0, -3], region: {min: [-0.03, -0.03, 0.0005], max: [0.03, 0, 0.1]}}
  - {name: balls, shape: ball, material: stone, count: 12, seed: 1, velocity: [0, 0, -3],
     region: {min: [-0.03, 0, 0.0005], max: [0.03, 0.03, 0.1]}}
walls:
  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.01], motion: {kind: translate, velocity: [0.2, 0, 0]}}
output: {series: 1e-3, frames: 0, checkpoint: 2e-3}
"""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.yaml"
    path.write_text(SCENE)
    return path


def scree(program, *arguments, **machine):
    """A finished program; machine: settings of the emulated one."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", **{f"CUDA_ON_CPU_{name}": str(value) for name, value in machine.items()})
    return subprocess.run([program, *map(str, arguments)], text=True, capture_output=True, timeout=300, env=environment)


def run(program, scene, folder, *options, expect=0, **machine):
    done = scree(program, "run", scene, "-o", folder, "--quiet", *options, **machine)
    assert done.returncode == expect, done.stdout + done.stderr
    return done


def state_of(folder):
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["counters"]["contacts"] > 8
    return summary["state_hash"], summary["energies"]


def test_a_run_on_the_device_is_that_of_the_cpu(scene, tmp_path):
    run(BUILD / "scree", scene, tmp_path / "cpu")
    run(EMULATED, scene, tmp_path / "cuda", "--device", "cuda")
    assert state_of(tmp_path / "cuda") == state_of(tmp_path / "cpu")


def test_progress_leaves_the_state_on_the_device(scene, tmp_path):
    """It tells the energy of the last row of series.csv, and of when that is."""
    text, code = on_terminal([EMULATED, "run", scene, "-o", tmp_path / "run", "--device", "cuda"],
                             dict(os.environ, OMP_NUM_THREADS="1"))
    assert code == 0
    lines = re.findall(r"  t ([0-9.e-]+) s  left [^\r]*  E_kin ([^ ]+) J(?: at ([0-9.e-]+) s)?\033\[K", text)
    rows = {f"{float(row['time [s]']):.4g}": float(row["kinetic [J]"]) + float(row["rotational [J]"])
            for row in csv.DictReader((tmp_path / "run/series.csv").read_text().splitlines())}
    older = [line for line in lines if line[2] != ""]
    assert older and lines[-1][2] == ""
    for now, energy, then in older:
        assert 0 <= float(now) - float(then) <= 1.02e-3
        assert energy == f"{rows[then]:.3g}"


@pytest.mark.parametrize("machine, words", [
    ({"DEVICES": 0}, "no NVIDIA GPU"),
    ({"CAPABILITY": 75}, "compute capability 7.5"),
    ({"CODE": 90, "CAPABILITY": 110}, "CMAKE_CUDA_ARCHITECTURES=110"),
    ({"DRIVER": 11000}, "update the driver"),
    ({"DRIVER": 0}, "no NVIDIA driver"),
])
def test_machines_that_cannot_are_refused_before_anything_is_written(scene, tmp_path, machine, words):
    done = run(EMULATED, scene, tmp_path / "run", "--device", "cuda", expect=1, **machine)
    assert words in done.stderr and "CPU" in done.stderr
    assert not (tmp_path / "run" / "checkpoint.h5").exists()


def test_numbers_of_devices(scene, tmp_path):
    done = run(EMULATED, scene, tmp_path / "run", "--device", "cuda:1", expect=1)
    assert "there is no GPU 1: this machine has 1" in done.stderr
    done = run(EMULATED, scene, tmp_path / "run", "--device", "cuda:first", expect=2)
    assert "cuda:first" in done.stderr
    done = run(BUILD / "scree", scene, tmp_path / "run", "--device", "cuda", expect=1)
    assert "has no CUDA" in done.stderr


def test_a_scene_that_does_not_fit_is_refused_with_what_it_needs(scene, tmp_path):
    def write(num_balls):
        text = SCENE.replace("count: 12, seed: 1, velocity", f"count: {num_balls}, seed: 1, velocity")
        scene.write_text(text.replace("max: [0.03, 0.03, 0.1]", "max: [0.03, 0.03, 90]"))

    write(9000)
    done = run(EMULATED, scene, tmp_path / "run", "--device", "cuda", expect=1, MEMORY=20_000_000)
    assert "has 20 MB of free memory, the scene needs about" in done.stderr and "fewer particles" in done.stderr
    assert not (tmp_path / "run" / "checkpoint.h5").exists()
    # a little fewer than it says do fit, a little more do not
    num = int(re.search(r"about (\d+) would fit", done.stderr)[1])
    assert 1000 < num < 9000
    for share, answer in ((0.98, "free: fits"), (1.02, "does not fit; about")):
        write(int(share * num) - 12)
        assert answer in scree(EMULATED, "check", scene, "--device", "cuda", MEMORY=20_000_000).stdout


def test_beds_are_measured_on_the_device(tmp_path):
    here, there = tmp_path / "cpu.json", tmp_path / "cuda.json"
    for path, device in ((here, "cpu"), (there, "cuda")):
        done = scree(EMULATED, "bench", "packing", "--shape", "cube", "--particles", 30, "--steps", 2, "--search-every", 2,
                     "--repetitions", 1, "--device", device, "--json", path)
        assert done.returncode == 0, done.stderr
    case, other = (json.loads(path.read_text())["cases"][0] for path in (here, there))
    assert case["contacts"] == other["contacts"] > 0 and case["pairs"] == other["pairs"]
    assert other["core_seconds"] == other["wall_seconds"] > 0
    done = scree(EMULATED, "bench", "rig", "--device", "cuda")
    assert done.returncode == 2 and "for packing, spheres" in done.stderr


def check_a_broken_run(scene, folder, done, whole):
    """Exit code 1 with words, a whole checkpoint, a summary that tells nothing of the lost state, and the unbroken run's state
    when the CPU goes on."""
    assert "GPU" in done.stderr and "--restart" in done.stdout + done.stderr, done.stdout + done.stderr
    assert (folder / "checkpoint.h5").exists() and not (folder / "checkpoint.h5.tmp").exists()
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["outcome"] == "failed" and summary["state_hash"] is None and summary["wall_loads"] == {}
    numbers = [summary["balance"], summary["energy_error"], *summary["energies"].values(), *summary["counters"].values()]
    assert len(numbers) > 10 and set(numbers) == {None}
    assert 0 < summary["step"] < summary["num_steps"] and summary["initial_energy"] is not None
    # the series ends before the step that failed
    last_row = (folder / "series.csv").read_text().splitlines()[-1].split(",")
    assert float(last_row[0]) < summary["time"] + 1e-9
    run(BUILD / "scree", scene, folder, "--restart")
    assert state_of(folder)[0] == state_of(whole)[0]


def test_after_a_kernel_fault_the_run_goes_on_from_its_checkpoint(scene, tmp_path):
    run(BUILD / "scree", scene, tmp_path / "whole")
    # each step has some thirty launches, and the first checkpoint comes after a hundred steps
    done = run(EMULATED, scene, tmp_path / "broken", "--device", "cuda", expect=1, FAULT_AT=12000)
    check_a_broken_run(scene, tmp_path / "broken", done, tmp_path / "whole")


def test_after_memory_has_ended_the_run_goes_on_from_its_checkpoint(scene, tmp_path):
    # a wide device and rocks of many triangles: at the first overlap of two, step 81, their buffers do not fit into what was taken at the start
    scene.write_text(SCENE.replace("checkpoint: 2e-3", "checkpoint: 1e-4").replace("triangles: 20", "triangles: 600"))
    run(BUILD / "scree", scene, tmp_path / "whole")
    done = run(EMULATED, scene, tmp_path / "broken", "--device", "cuda", expect=1, NO_MEMORY_AT=3, WORKERS=16)
    assert "step 81" in done.stderr and "has no memory for" in done.stderr
    check_a_broken_run(scene, tmp_path / "broken", done, tmp_path / "whole")
