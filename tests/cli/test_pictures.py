"""tools/pictures.py on a small run: the pictures are there, have their size and show something. tools/contact_forces.py on a
body at rest: its weight."""
import csv
import math
import os
import subprocess
import sys
from pathlib import Path

import matplotlib.image
import pytest

PROGRAM = str(Path(os.environ.get("SCREE_PROGRAM", "build/release/scree")).resolve())
PICTURES = Path(__file__).resolve().parents[2] / "tools" / "pictures.py"

SCENE = """
name: small
time: {end: 0.02, step: 1e-4}
materials: [{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]
contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]
shapes:
  - {name: rock, source: rock, triangles: 20, seed: 3}
  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}
particles:
  - {name: rocks, shape: rock, material: stone, count: 8, seed: 1, velocity: [0, 0, -1],
     size: {distribution: uniform, min: 0.01, max: 0.02},
     region: {min: [-0.06, -0.06, 0.001], max: [0.06, 0.06, 0.1]}}
walls:
  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.01]}
repose: {measure: true, from: -0.08, to: 0.08, bins: 8}
output: {series: 0.001, frames: 0.002, checkpoint: 0}
"""


def draw(folder):
    return subprocess.run([sys.executable, "-B", str(PICTURES), str(folder)], capture_output=True, text=True, timeout=600)


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    (folder / "small.yaml").write_text(SCENE)
    done = subprocess.run([PROGRAM, "run", str(folder / "small.yaml"), "-o", str(folder / "run"), "--quiet"],
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return folder / "run"


def test_pictures_of_a_small_run(run_folder):
    done = draw(run_folder)
    assert done.returncode == 0, done.stderr
    for name in ["pile", "strip", "energy", "contact_forces", "height_map"]:
        pixels = matplotlib.image.imread(run_folder / "pictures" / f"{name}.png")[..., :3]
        assert pixels.shape[0] >= 400 and pixels.shape[1] >= 600
        # more than a blank sheet: a good share of the pixels differs from the background
        assert (abs(pixels - pixels[0, 0]).max(axis=2) > 0.1).mean() > 0.005


def test_a_folder_that_is_no_run(tmp_path):
    for folder in [tmp_path, tmp_path / "missing"]:
        done = draw(folder)
        assert done.returncode == 1 and done.stderr.strip() and "Traceback" not in done.stderr


def test_contact_forces_of_a_ball_at_rest_are_its_weight(tmp_path):
    ball = SCENE.split("repose:")[0].replace("end: 0.02", "end: 1").replace("damping_ratio: 0.3", "damping_ratio: 1")
    ball = ball.replace("source: rock, triangles: 20, seed: 3", "source: sphere, size: 0.02").split("particles:")[0]
    ball += """
particles:
  - {name: ball, shape: rock, material: stone, bodies: [{position: [0, 0, 0.01]}, {position: [0.05, 0, 0.01]}]}
walls:
  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.01]}
output: {series: 0.1, frames: 0.5, checkpoint: 0}
"""
    (tmp_path / "ball.yaml").write_text(ball)
    subprocess.run([PROGRAM, "run", str(tmp_path / "ball.yaml"), "-o", str(tmp_path / "run"), "--quiet"], check=True, timeout=120)
    tool = PICTURES.with_name("contact_forces.py")
    subprocess.run([sys.executable, "-B", str(tool), str(tmp_path / "run")], check=True, capture_output=True, timeout=120)
    with open(tmp_path / "run" / "contact_forces.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3 and rows[0]["contacts"] == "0"
    last = {name: float(value) for name, value in rows[-1].items()}
    weight = 2500 * 4 / 3 * math.pi * 0.01**3 * 9.81
    assert (last["contacts"], last["wall_contacts"]) == (2, 2)
    for name in ("mean_normal_force", "largest_normal_force"):
        assert last[name] == pytest.approx(weight, rel=1e-6)  # frames are in single precision
    assert last["deviation_normal_force"] < 1e-6 * weight and last["mean_tangential_force"] < 1e-6 * weight
    assert last["anisotropy"] == pytest.approx(1) and last["force_anisotropy"] == pytest.approx(1)


def test_a_run_without_contacts_is_told(tmp_path):
    tool = PICTURES.with_name("contact_forces.py")
    (tmp_path / "series.csv").write_text("time [s]\n0\n")
    done = subprocess.run([sys.executable, "-B", str(tool), str(tmp_path)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 1 and "output.frames" in done.stderr and "Traceback" not in done.stderr
