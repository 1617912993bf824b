"""True spheres as a user meets them: frames, pictures, restart bit for bit, any number of threads.

SCREE_PROGRAM names the program. Frames are read with VTK: not with scree's own code.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import vtk
from vtk.util.numpy_support import vtk_to_numpy

PROGRAM = str(Path(os.environ.get("SCREE_PROGRAM", "build/release/scree")).resolve())
PILE = Path(__file__).resolve().parents[2] / "tools" / "pile.py"

SCENE = """
name: balls and dice
gravity: [0, 0, -300]
time: {end: 0.03, step: 1e-4}
materials: [{name: glass, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}]
contact_laws: [{materials: [glass, glass], friction_coefficient: 0.4, restitution_coefficient: 0.5}]
shapes:
  - {name: ball, source: sphere, size: 0.02}
  - {name: dice, source: box, size: 0.01}
  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}
particles:
  - {name: balls, shape: ball, material: glass, count: 30, seed: 1, velocity: [0, 0, -3],
     size: {distribution: uniform, min: 0.01, max: 0.02}, region: {min: [-0.06, -0.06, 0.001], max: [0.06, 0.06, 0.1]}}
  - {name: dice, shape: dice, material: glass, count: 10, seed: 2, velocity: [0, 0, -3],
     region: {min: [-0.06, -0.06, 0.1], max: [0.06, 0.06, 0.2]}}
walls:
  - {name: floor, shape: floor, material: glass, position: [0, 0, -0.01]}
output: {series: 1e-3, frames: 5e-3, checkpoint: 5e-3}
"""


def run(*arguments):
    done = subprocess.run([PROGRAM, "run", *map(str, arguments), "--quiet"], text=True, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done


def summary_of(folder):
    return json.loads((folder / "summary.json").read_text())


def last_frame(path):
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    reader.SetStep(reader.GetNumberOfSteps() - 1)
    reader.Update()
    return reader.GetOutput()


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    folder = tmp_path_factory.mktemp("spheres")
    (folder / "scene.yaml").write_text(SCENE)
    run(folder / "scene.yaml", "-o", folder / "run")
    return folder / "run"


def test_frames_hold_points_with_radii(whole):
    data = last_frame(whole / "spheres.vtkhdf")
    assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == 30
    arrays = {name: vtk_to_numpy(data.GetPointData().GetArray(name))
              for name in ("particle", "group", "radius", "speed", "velocity")}
    assert arrays["particle"].tolist() == list(range(30)) and not arrays["group"].any()
    assert arrays["radius"].min() >= 0.005 and arrays["radius"].max() <= 0.01 and np.ptp(arrays["radius"]) > 0.001
    assert np.allclose(np.linalg.norm(arrays["velocity"], axis=1), arrays["speed"], rtol=1e-5)
    # none has sunk into the floor by more than a tenth of its radius, and some lie on it
    height = vtk_to_numpy(data.GetPoints().GetData())[:, 2] - arrays["radius"]
    assert (height > -0.1 * arrays["radius"]).all() and (height < 0).sum() >= 3
    dice = last_frame(whole / "frames.vtkhdf")
    assert dice.GetNumberOfPoints() == 80
    assert set(vtk_to_numpy(dice.GetPointData().GetArray("particle"))) == set(range(30, 40))


def test_energy_is_accounted_for(whole):
    # velocity Verlet keeps an energy that differs from the true one by (w dt)^2/8 at most, w of the stiffest contact
    counters = summary_of(whole)["counters"]
    assert abs(summary_of(whole)["energy_error"]) < (1e-4 / counters["smallest_critical_step"]) ** 2 / 8
    assert counters["inside"] == 0


def test_spheres_alone_leave_no_file_of_surfaces(tmp_path):
    scene = SCENE.replace("  - {name: dice, shape: dice", "#").replace("     region: {min: [-0.06, -0.06, 0.1]", "#")
    (tmp_path / "scene.yaml").write_text(scene)
    run(tmp_path / "scene.yaml", "-o", tmp_path / "run")
    assert (tmp_path / "run/spheres.vtkhdf").exists() and not (tmp_path / "run/frames.vtkhdf").exists()


@pytest.mark.parametrize("threads", [2, 7])
def test_same_bits_for_any_number_of_threads(whole, tmp_path, threads):
    run(whole / "scene.yaml", "-o", tmp_path / "run", "--threads", threads)
    assert summary_of(tmp_path / "run")["state_hash"] == summary_of(whole)["state_hash"]


def test_restart_gives_the_same_bits_and_frames(whole, tmp_path):
    run(whole / "scene.yaml", "-o", tmp_path / "run", "--set", "time.end=0.0131")
    run(whole / "scene.yaml", "-o", tmp_path / "run", "--restart")
    assert summary_of(tmp_path / "run")["state_hash"] == summary_of(whole)["state_hash"]
    ours, theirs = last_frame(tmp_path / "run/spheres.vtkhdf"), last_frame(whole / "spheres.vtkhdf")
    assert np.array_equal(vtk_to_numpy(ours.GetPoints().GetData()), vtk_to_numpy(theirs.GetPoints().GetData()))


TRIO = "spheres: [{position: [0, 0, 0], radius: 0.006}, {position: [0.007, 0, 0], radius: 0.005}, {position: [0, 0.008, 0], radius: 0.004}]"


def test_clumps_are_rigid_points_in_the_same_file(tmp_path):
    scene = SCENE.replace("{name: dice, source: box, size: 0.01}", "{name: dice, source: clump, " + TRIO + "}")
    (tmp_path / "scene.yaml").write_text(scene)
    run(tmp_path / "scene.yaml", "-o", tmp_path / "whole")
    assert not (tmp_path / "whole/frames.vtkhdf").exists()
    data = last_frame(tmp_path / "whole/spheres.vtkhdf")
    particle = vtk_to_numpy(data.GetPointData().GetArray("particle"))
    radius = vtk_to_numpy(data.GetPointData().GetArray("radius"))
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    assert particle.tolist() == [*range(30), *np.repeat(range(30, 40), 3)]
    heights = []
    for i in range(30, 40):
        own = points[particle == i]
        sides = [np.linalg.norm(own[a] - own[b]) for a, b in ((0, 1), (0, 2), (1, 2))]
        assert np.allclose(sides, [0.007, 0.008, np.hypot(0.007, 0.008)], rtol=1e-4)
        assert np.allclose(radius[particle == i], [0.006, 0.005, 0.004], rtol=1e-6)
        heights.append((own[:, 2] - radius[particle == i]).min())
    assert min(heights) > -4e-4 and sum(height < 0.02 for height in heights) >= 2  # on the floor or on others, not in it
    # restart and threads
    run(tmp_path / "scene.yaml", "-o", tmp_path / "parts", "--set", "time.end=0.0131", "--threads", 2)
    run(tmp_path / "scene.yaml", "-o", tmp_path / "parts", "--restart", "--threads", 2)
    assert summary_of(tmp_path / "parts")["state_hash"] == summary_of(tmp_path / "whole")["state_hash"]
    # a check says what it is made of, and a clump in two pieces is refused
    wrong = scene.replace("position: [0, 0.008, 0]", "position: [0, 0.08, 0]")
    (tmp_path / "wrong.yaml").write_text(wrong)
    done = subprocess.run([PROGRAM, "check", str(tmp_path / "wrong.yaml")], text=True, capture_output=True, timeout=60)
    assert done.returncode == 2 and "not connected: number 2" in done.stdout + done.stderr
    done = subprocess.run([PROGRAM, "check", str(tmp_path / "scene.yaml")], text=True, capture_output=True, timeout=60)
    assert done.returncode == 0 and "clumps: closed form" in done.stdout


def test_picture_of_spheres(whole, tmp_path):
    matplotlib_image = pytest.importorskip("matplotlib.image")
    done = subprocess.run([sys.executable, "-B", str(PILE), str(whole), "-o", str(tmp_path / "pile.png")],
                          capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    pixels = matplotlib_image.imread(tmp_path / "pile.png")[..., :3]
    assert (abs(pixels - pixels[0, 0]).max(axis=2) > 0.1).mean() > 0.005
