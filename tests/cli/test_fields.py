"""Fields of a run as a user meets them: fields.vtkhdf opened by VTK and by h5py, restart, replace, pictures, faults."""
import json
import os
import subprocess
import sys
from pathlib import Path

import h5py
import matplotlib.image
import numpy as np
import pytest
import vtk
from vtk.util.numpy_support import vtk_to_numpy

PROGRAM = str(Path(os.environ.get("SCREE_PROGRAM", "build/release/scree")).resolve())
TOOLS = Path(__file__).resolve().parents[2] / "tools"

SCENE = """
name: small drum
time: {end: 0.36, step: 1e-4}
materials: [{name: stone, density: 2500, youngs_modulus: 1e6, poisson_ratio: 0.25}]
contact_laws: [{materials: [stone, stone], friction_coefficient: 0.5, damping_ratio: 0.3}]
shapes:
  - {name: cube, source: box, size: 0.01}
  - name: drum
    source: turned
    segments: 24
    profile: [{radius: 0, height: -0.03}, {radius: 0.06, height: -0.03}, {radius: 0.06, height: 0.03},
      {radius: 0, height: 0.03}, {radius: 0, height: 0.02}, {radius: 0.05, height: 0.02},
      {radius: 0.05, height: -0.02}, {radius: 0, height: -0.02}]
particles:
  - {name: fill, shape: cube, material: stone, count: 12, seed: 3,
     region: {min: [-0.04, -0.02, -0.05], max: [0.04, 0.02, 0.05], cylinder: y}}
walls:
  - {name: drum, shape: drum, material: stone, orientation: [0.7071067811865476, -0.7071067811865476, 0, 0],
     motion: {kind: rotate, axis: [0, 1, 0], angular_velocity: -40}}
output: {series: 0.01, frames: 0, checkpoint: 0.1}
fields: {measure: true, region: {min: [-0.06, -0.02, -0.06], max: [0.06, 0.02, 0.06]}, cells: [12, 2, 10],
  wall: drum, samples: 40, energy_bins: 30, energy_min: 1e-9, energy_max: 1e-2}
"""
PERIOD = 2 * np.pi / 40


def run(*arguments, expect=0):
    done = subprocess.run([PROGRAM, "run", *map(str, arguments)], text=True, capture_output=True, timeout=300)
    assert done.returncode == expect, done.stdout + done.stderr
    return done


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "drum.yaml"
    path.write_text(SCENE)
    return path


@pytest.fixture(scope="module")
def whole(scene, tmp_path_factory):
    folder = tmp_path_factory.mktemp("whole") / "run"
    run(scene, "-o", folder, "--quiet")
    return folder


def test_vtk_opens_the_fields(whole):
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(whole / "fields.vtkhdf"))
    reader.Update()
    image = reader.GetOutputDataObject(0)
    assert image.GetDimensions() == (13, 3, 11)
    assert np.allclose(image.GetOrigin(), (-0.06, -0.02, -0.06)) and np.allclose(image.GetSpacing(), (0.01, 0.02, 0.012))
    cells = image.GetCellData()
    with h5py.File(whole / "fields.vtkhdf") as file:
        for name in ("solid_fraction", "velocity", "speed", "granular_temperature"):
            stored = file["VTKHDF/CellData"][name][:]
            seen = vtk_to_numpy(cells.GetArray(name))
            assert np.array_equal(seen, stored.reshape(seen.shape), equal_nan=True)
            assert file["VTKHDF/CellData"][name].attrs["unit"]


def test_the_fields_hold_the_particles(whole):
    with h5py.File(whole / "fields.vtkhdf") as file:
        cells = file["VTKHDF/CellData"]
        fraction = cells["solid_fraction"][:]
        volume = fraction.sum() * 0.01 * 0.02 * 0.012
        assert abs(volume - 12 * 1e-6) < 1e-12 * volume * fraction.size
        assert file["averages"].attrs["num_periods"] == 2 and file["averages"].attrs["samples"] == 40
        assert abs(file["averages"].attrs["period"] - PERIOD) < 1e-15
        full = fraction > 0
        assert np.isnan(cells["speed"][:][~full]).all() and np.isfinite(cells["speed"][:][full]).all()
        velocity = cells["velocity"][:][full]
        # a mean is never longer than the mean of the lengths; the temperature is what is missing
        assert (np.linalg.norm(velocity, axis=1) <= cells["speed"][:][full] * (1 + 1e-12)).all()
        assert (cells["granular_temperature"][:][full] >= 0).all()
        for kind in ("collisions_of_particles", "collisions_with_walls"):
            group = file[kind]
            assert group["count_normal"][:].sum() == group["count_tangential"][:].sum() > 0
            assert len(group["bin_edges"]) == 31 and len(group["count_normal"]) == 32


def test_power_is_the_work_of_the_wall_over_time(whole):
    summary = json.loads((whole / "summary.json").read_text())
    rows = (whole / "series.csv").read_text().splitlines()
    names = rows[0].split(",")
    column = names.index("work_drum [J]")
    table = np.array([row.split(",") for row in rows[1:]], dtype=float)
    assert names[column - 1] == "torque_drum [N m]"
    assert np.isclose(table[-1, column], summary["wall_loads"]["drum"]["work"], rtol=1e-15)
    assert np.isclose(table[-1, column], summary["energies"]["input"], rtol=1e-11)
    # that of two revolutions is near those of the rows around their end, by no more than it changes there
    with h5py.File(whole / "fields.vtkhdf") as file:
        work = file["averages/power"][0] * 2 * PERIOD
    low, high = np.searchsorted(table[:, 0], 2 * PERIOD) - 1, np.searchsorted(table[:, 0], 2 * PERIOD)
    margin = np.abs(np.diff(table[low - 1:high + 2, column])).max()
    assert min(table[low:high + 1, column]) - margin <= work <= max(table[low:high + 1, column]) + margin
    assert summary["fields_periods"] == 2
    assert np.isclose(summary["wall_loads"]["drum"]["power_of_periods"] * 2 * PERIOD, work, rtol=1e-12)


def test_torque_is_the_mean_of_the_rows(tmp_path):
    """A row per step; the drum turns in a part of the second period only, the floor never."""
    folder = tmp_path / "run"
    floor = "  - {name: floor, shape: cube, material: stone, position: [0, 0, -1]}\noutput:"
    (tmp_path / "scene.yaml").write_text(SCENE.replace("output:", floor))
    run(tmp_path / "scene.yaml", "-o", folder, "--quiet", "--set", "output.series=1e-4", "--set", "walls.drum.motion.start=0.19995",
        "--set", "fields.wall=''", "--set", "fields.period=0.15")
    lines = (folder / "series.csv").read_text().splitlines()
    table = np.array([line.split(",") for line in lines[1:]], dtype=float)
    torque = table[:, lines[0].split(",").index("torque_drum [N m]")]
    with h5py.File(folder / "fields.vtkhdf") as file:
        mean, none = file["averages/torque"][:]
        power = file["averages/power"][0]
        assert file["averages/torque"].attrs["unit"] == b"N m" and file["averages"].attrs["num_periods"] == 2
    # steps 2000 to 3000 turn it, over 0.10005 s
    assert np.isclose(table[3000, 0], 0.3, rtol=1e-12) and np.isnan(none)
    assert np.isclose(mean, torque[2000:3001].sum() * 1e-4 / 0.10005, rtol=1e-9) and abs(mean) > 1e-6
    assert np.isclose(mean * -40 * 0.10005, power * 0.3, rtol=1e-12)
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["wall_loads"]["drum"]["torque_of_periods"] == mean


def test_a_restart_gives_the_same_file(scene, whole, tmp_path):
    run(scene, "-o", tmp_path / "run", "--quiet", "--set", "time.end=0.2")
    first = (tmp_path / "run/fields.vtkhdf").read_bytes()
    run(scene, "-o", tmp_path / "run", "--quiet", "--restart", "--threads", "2")
    again = (tmp_path / "run/fields.vtkhdf").read_bytes()
    assert again == (whole / "fields.vtkhdf").read_bytes() and again != first


def test_replacing_removes_old_fields(scene, tmp_path):
    run(scene, "-o", tmp_path / "run", "--quiet", "--set", "time.end=0.17")
    assert (tmp_path / "run/fields.vtkhdf").exists()
    run(scene, "-o", tmp_path / "run", "--quiet", "--replace", "--set", "time.end=0.01")
    assert not (tmp_path / "run/fields.vtkhdf").exists()


def test_faults_of_the_section_are_told_together(scene):
    done = run(scene, "--set", "fields.region.max.2=-1", "--set", "fields.cells=[1.5, 1, 1]", "--set", "fields.wall=drun",
               "--set", "fields.energy_min=1", expect=2)
    for text in ('region of fields is empty: along z', "cells of fields is [1.5, 1, 1]", 'did you mean "drum"?',
                 "energy_min of fields is 1 J"):
        assert text in done.stderr
    done = run(scene, "--set", "fields.period=1", expect=2)
    assert "fields has both period and wall; remove one" in done.stderr
    done = run(scene, "--set", 'fields.wall=""', expect=2)
    assert "fields has neither period nor wall" in done.stderr
    done = run(scene, "--set", "walls.drum.motion={kind: fixed}", expect=2)
    assert 'wall of fields is "drum", whose motion is fixed' in done.stderr
    done = run(scene, "--set", "fields.samples=10000", expect=2)
    assert "samples in a period" in done.stderr and "1570 or less" in done.stderr


def test_pictures_of_the_fields(whole):
    done = subprocess.run([sys.executable, "-B", str(TOOLS / "fields.py"), str(whole)], capture_output=True, text=True,
                          timeout=600)
    assert done.returncode == 0, done.stderr
    for name in ("porosity", "velocity", "power", "collisions"):
        pixels = matplotlib.image.imread(whole / "pictures" / f"{name}.png")[..., :3]
        assert (abs(pixels - pixels[0, 0]).max(axis=2) > 0.1).mean() > 0.005


def test_pictures_need_fields(tmp_path):
    done = subprocess.run([sys.executable, "-B", str(TOOLS / "fields.py"), str(tmp_path)], capture_output=True, text=True)
    assert done.returncode == 1 and done.stderr.strip() and "Traceback" not in done.stderr


def test_counts_of_particles_that_fly_apart(tmp_path):
    (tmp_path / "scene.yaml").write_text("""
name: apart
gravity: [0, 0, 0]
time: {end: 1, step: 1e-3}
materials: [{name: stone, density: 2500, youngs_modulus: 1e6, poisson_ratio: 0.25}]
contact_laws: [{materials: [stone, stone], friction_coefficient: 0.5, damping_ratio: 0.3}]
shapes:
  - {name: cube, source: box, size: 0.1}
  - {name: ball, source: sphere, size: 0.1}
particles:
  - {name: cubes, shape: cube, material: stone, bodies: [{position: [-1, 0, 0], velocity: [3, 0, 1]}]}
  - {name: balls, shape: ball, material: stone,
     bodies: [{position: [0.5, 1, 0], velocity: [-1, 0, 0]}, {position: [0.9, -1, 0]}]}
output: {series: 0.1, frames: 0.5, checkpoint: 0}
""")
    run(tmp_path / "scene.yaml", "-o", tmp_path / "run", "--quiet")
    counts = [sys.executable, "-B", str(TOOLS / "counts.py"), str(tmp_path / "run")]
    done = subprocess.run([*counts, "--zone", "right: x > 0.1", "--mean", "cubes"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = [line.split(",") for line in (tmp_path / "run/counts.csv").read_text().splitlines()]
    assert rows[0] == ["time [s]", "cubes in right [1]", "balls in right [1]", "x of cubes [m]", "y of cubes [m]", "z of cubes [m]"]
    table = np.array(rows[1:], dtype=float)
    assert np.allclose(table, [[0, 0, 2, -1, 0, 0], [0.5, 1, 1, 0.5, 0, 0.5], [1, 1, 1, 2, 0, 1]], atol=1e-6)
    for bad in (["--zone", "right x > 0"], ["--mean", "cones"], []):
        done = subprocess.run([*counts, *bad], capture_output=True, text=True)
        assert done.returncode != 0 and "Traceback" not in done.stderr and done.stderr.strip()
