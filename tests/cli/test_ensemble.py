"""tools/ensemble.py: a grid of runs and its table, against single runs; stopped, gone on with, refused."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

PROGRAM = str(Path(os.environ.get("SCREE_PROGRAM", "build/release/scree")).resolve())
TOOL = Path(__file__).resolve().parents[2] / "tools" / "ensemble.py"

SCENE = """
name: falling cubes
gravity: [0, 0, -9.81]
time: {end: 0.1, step: 1e-4}
materials:
  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}
contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]
shapes:
  - {name: cube, source: box, size: [0.01, 0.01, 0.01]}
  - {name: floor, source: box, size: [0.1, 0.1, 0.01]}
particles:
  - {name: cubes, shape: cube, material: stone, count: 8, seed: 1,
     region: {min: [-0.03, -0.03, 0.001], max: [0.03, 0.03, 0.04]}}
walls:
  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.005]}
output: {series: 1e-2, frames: 0, checkpoint: 1e-2}
"""
GRID = ["--vary", "contact_laws.0.friction_coefficient=0.1,0.5", "--vary", "particles.cubes.seed=1..3"]


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.yaml"
    path.write_text(SCENE)
    return path


def command(scene, folder, *arguments):
    return [sys.executable, "-B", str(TOOL), str(scene), "-o", str(folder), "--program", PROGRAM, "--jobs", "2", *arguments]


def ensemble(scene, folder, *arguments, expect=0):
    done = subprocess.run(command(scene, folder, *arguments), text=True, capture_output=True, timeout=120)
    assert done.returncode == expect, done.stdout + done.stderr
    return done


def table_of(folder):
    with open(folder / "ensemble.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_each_row_is_the_run_alone(scene, tmp_path):
    folder = tmp_path / "grid"
    ensemble(scene, folder, *GRID)
    rows = table_of(folder)
    assert [(row["friction_coefficient"], row["seed"]) for row in rows] == [(f, s) for f in ("0.1", "0.5") for s in "123"]
    assert len({row["state_hash"] for row in rows}) == 6
    for row in rows:
        alone = tmp_path / ("alone " + row["folder"])
        settings = ["--set", f"contact_laws.0.friction_coefficient={row['friction_coefficient']}",
                    "--set", f"particles.cubes.seed={row['seed']}"]
        subprocess.run([PROGRAM, "run", str(scene), "-o", str(alone), "--quiet", *settings], check=True, timeout=120)
        summary = json.loads((alone / "summary.json").read_text())
        assert row["state_hash"] == summary["state_hash"]
        assert float(row["energies.kinetic"]) == summary["energies"]["kinetic"]


def test_a_second_call_keeps_what_is_finished(scene, tmp_path):
    folder = tmp_path / "grid"
    ensemble(scene, folder, *GRID)
    before = {path: path.stat().st_mtime_ns for path in folder.glob("*/summary.json")}
    table = (folder / "ensemble.csv").read_bytes()
    assert "finished" not in ensemble(scene, folder, *GRID).stdout
    # a larger grid only adds to it
    ensemble(scene, folder, *GRID[:2], "--vary", "particles.cubes.seed=1..4")
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert len(table_of(folder)) == 8
    ensemble(scene, folder, *GRID)
    assert (folder / "ensemble.csv").read_bytes() == table


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT], ids=lambda s: s.name)
def test_stopped_and_gone_on_with(scene, tmp_path, number):
    whole, stopped = tmp_path / "whole", tmp_path / "stopped"
    grid = ["--vary", "particles.cubes.seed=1..2", "--set", "time.end=2"]
    ensemble(scene, whole, *grid)
    # as from a terminal: Ctrl-C reaches the whole group
    process = subprocess.Popen(command(scene, stopped, *grid), text=True, start_new_session=True, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
    deadline = time.monotonic() + 60
    while not list(stopped.glob("*/checkpoint.h5")):
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.005)
    if number == signal.SIGINT:
        os.killpg(process.pid, number)
    else:
        process.send_signal(number)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "the same command goes on" in errors
    assert not (stopped / "ensemble.csv").exists()
    ensemble(scene, stopped, *grid)
    assert [row["state_hash"] for row in table_of(stopped)] == [row["state_hash"] for row in table_of(whole)]


def test_one_failing_run_is_named_and_the_others_kept(scene, tmp_path):
    folder = tmp_path / "grid"
    done = ensemble(scene, folder, "--vary", "contact_laws.0.damping_ratio=0.2,-3", expect=1)
    assert "damping_ratio=-3 did not finish: " in done.stderr and "damping_ratio" in done.stderr.split("finish: ")[1]
    assert [row["damping_ratio"] for row in table_of(folder)] == ["0.2"]


def test_other_values_in_the_same_folder_are_refused(scene, tmp_path):
    folder = tmp_path / "grid"
    vary = ["--vary", "particles.cubes.seed=1,2"]
    ensemble(scene, folder, *vary)
    done = ensemble(scene, folder, *vary, "--set", "time.end=0.05", expect=2)
    assert "--replace" in done.stderr
    assert {float(row["time"]) for row in table_of(folder)} == {0.1}
    ensemble(scene, folder, *vary, "--set", "time.end=0.05", "--replace")
    assert {float(row["time"]) for row in table_of(folder)} == {0.05}


@pytest.mark.parametrize("vary, told", [
    ("particles.cubes.seed", "PATH=VALUE"),
    ("=1,2", "PATH=VALUE"),
    ("particles.cubes.seed=", "PATH=VALUE"),
    ("particles.cubes.seed=5..2", "empty"),
    ("particles.cubes.seed=1,2,1", "twice"),
])
def test_bad_values_are_refused(scene, tmp_path, vary, told):
    assert told in ensemble(scene, tmp_path / "grid", "--vary", vary, expect=2).stderr
    assert not (tmp_path / "grid").exists()


def test_missing_files_are_refused(scene, tmp_path):
    assert "there is no scene" in ensemble(tmp_path / "none.yaml", tmp_path / "grid", expect=2).stderr
    missing = ["--program", str(tmp_path / "none")]
    assert "make build" in ensemble(scene, tmp_path / "grid", *missing, expect=2).stderr
