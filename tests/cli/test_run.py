"""scree run as a user meets it: what it writes, how it is stopped, killed, gone on with and refused.

SCREE_PROGRAM names the program. Frames are read with VTK, the rest with h5py: not with scree's own code.
"""
import json
import math
import os
import random
import re
import shlex
import shutil
import signal
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from terminal import on_terminal

PROGRAM = os.environ.get("SCREE_PROGRAM", "build/release/scree")
PROGRAM = str(Path(PROGRAM).resolve())
MODELS = Path(__file__).parents[2] / "models"

SCENE = """
name: few rocks
gravity: [0, 0, -300]
time: {end: 0.03, step: 5e-5}
materials:
  - {name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}
contact_laws: [{materials: [stone, stone], friction_coefficient: 0.4, damping_ratio: 0.3}]
shapes:
  - {name: rock, source: rock, triangles: 40, seed: 3}
  - {name: floor, source: box, size: [0.3, 0.3, 0.02]}
particles:
  - {name: rocks, shape: rock, material: stone, count: 25, seed: 1, velocity: [0, 0, -3],
     size: {distribution: uniform, min: 0.01, max: 0.02},
     region: {min: [-0.06, -0.06, 0.001], max: [0.06, 0.06, 0.1]}}
walls:
  - {name: floor, shape: floor, material: stone, position: [0, 0, -0.01],
     motion: {kind: translate, velocity: [0, 0, 0.3], start: 0.01, end: 0.02}}
  - {name: lid, shape: floor, material: stone, position: [0, 0, 0.3], removed_at: 0.0105}
output: {series: 1e-3, frames: 2e-3, checkpoint: 5e-3}
repose: {measure: true, from: -0.1, to: 0.1, base: 0}
"""
NUM_STEPS = 600


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.yaml"
    path.write_text(SCENE)
    return path


def run(*arguments, cwd=None, expect=0, **options):
    """scree run, finished; checked for its exit code."""
    done = subprocess.run([PROGRAM, "run", *map(str, arguments)], cwd=cwd, text=True, capture_output=True, timeout=120,
                          **options)
    assert done.returncode == expect, done.stdout + done.stderr
    return done


def start(*arguments, **options):
    return subprocess.Popen([PROGRAM, "run", *map(str, arguments)], text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, **options)


def summary_of(folder):
    def refuse(word):
        raise ValueError(f"{word} is not JSON")

    return json.loads((Path(folder) / "summary.json").read_text(), parse_constant=refuse)


def series_of(folder):
    lines = (Path(folder) / "series.csv").read_text().splitlines()
    names = lines[0].split(",")
    return {name: np.array(column, dtype=float) for name, column in zip(names, zip(*(row.split(",") for row in lines[1:])))}


class Frames:
    """A VTKHDF file through VTK's reader."""

    def __init__(self, path):
        self.reader = vtk.vtkHDFReader()
        self.reader.SetFileName(str(path))
        self.reader.UpdateInformation()
        steps = self.reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        self.times = list(steps or [])

    def at(self, k):
        self.reader.UpdateTimeStep(self.times[k])
        data = vtk.vtkPolyData()
        data.DeepCopy(self.reader.GetOutputDataObject(0))
        return data


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float) if data.GetNumberOfPoints() else np.zeros((0, 3))


def triangles_of(data):
    return vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def wait_for(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.002)


def same_datasets(first, second):
    """Every dataset of two VTKHDF files, as far as its steps reach, is equal."""
    frames = [Frames(first), Frames(second)]
    assert frames[0].times == frames[1].times
    for k in range(len(frames[0].times)):
        a, b = frames[0].at(k), frames[1].at(k)
        assert np.array_equal(points_of(a), points_of(b))
        assert a.GetNumberOfCells() == b.GetNumberOfCells()
        for data_a, data_b in ((a.GetPointData(), b.GetPointData()), (a.GetCellData(), b.GetCellData())):
            assert data_a.GetNumberOfArrays() == data_b.GetNumberOfArrays()
            for n in range(data_a.GetNumberOfArrays()):
                name = data_a.GetArrayName(n)
                assert np.array_equal(vtk_to_numpy(data_a.GetArray(name)), vtk_to_numpy(data_b.GetArray(name))), name


def assert_same_run(first, second):
    """Two finished runs of the same scene: same bits everywhere but in the times they took."""
    a, b = summary_of(first), summary_of(second)
    for key in ("wall_seconds", "processor_seconds", "particle_steps_per_second", "steps_run", "threads"):
        a.pop(key)
        b.pop(key)
    # how often neighbours were searched is no result: a restart searches once more
    a["counters"].pop("rebuilds")
    b["counters"].pop("rebuilds")
    a["counters"].pop("pairs")
    b["counters"].pop("pairs")
    assert a == b
    rows_a, rows_b = series_of(first), series_of(second)
    for name in rows_a:
        if name not in ("rebuilds [1]", "pairs [1]"):
            assert np.array_equal(rows_a[name], rows_b[name]), name
    for name in ("frames.vtkhdf", "walls.vtkhdf", "contacts.vtkhdf"):
        same_datasets(Path(first) / name, Path(second) / name)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The unbroken run that others are compared with."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "scene.yaml").write_text(SCENE)
    run(folder / "scene.yaml", "-o", folder / "run", "--threads", 1)
    return folder / "run"


# ---- what is written


def test_summary_agrees_with_series_and_checkpoint(whole):
    summary, series = summary_of(whole), series_of(whole)
    assert summary["outcome"] == "finished" and summary["scene"] == "few rocks"
    assert summary["step"] == NUM_STEPS and summary["steps_run"] == NUM_STEPS
    assert summary["time"] == pytest.approx(0.03, rel=1e-12)
    assert summary["particles"] == 25 and summary["walls"] == 2
    assert np.array_equal(series["step [1]"], np.arange(0, NUM_STEPS + 1, 20))
    assert summary["energies"]["kinetic"] == series["kinetic [J]"][-1]
    assert summary["initial_energy"] == series["balance [J]"][0]
    turned_over = sum(np.abs(series[name + " [J]"]) for name in (
        "kinetic", "rotational", "elastic_normal", "elastic_tangential", "damping", "friction", "hysteresis")).max()
    assert summary["energy_error"] == pytest.approx(
        (series["balance [J]"][-1] - series["balance [J]"][0]) / turned_over, rel=1e-9, abs=1e-15)
    assert len(summary["height_map_x"]) == len(summary["height_map_height"])
    with h5py.File(whole / "checkpoint.h5") as checkpoint:
        assert checkpoint.attrs["state_hash"].decode() == summary["state_hash"]
        assert checkpoint["now"].attrs["step"] == NUM_STEPS
        mass, velocity = checkpoint["particles/mass"][:], checkpoint["particles/velocity"][:]
        assert checkpoint["particles/velocity"].attrs["unit"] == b"m/s"
        assert 0.5 * np.sum(mass * np.sum(velocity**2, axis=1)) == pytest.approx(summary["energies"]["kinetic"])
        assert mass.sum() == pytest.approx(summary["mass"], rel=1e-12)


def test_vtk_reads_every_frame(whole):
    frames = Frames(whole / "frames.vtkhdf")
    assert np.allclose(frames.times, np.arange(16) * 2e-3, rtol=1e-12, atol=0)
    first = frames.at(0)
    particle = vtk_to_numpy(first.GetPointData().GetArray("particle"))
    assert first.GetNumberOfCells() == 25 * 40 and set(particle) == set(range(25))
    for k in range(16):
        data = frames.at(k)
        assert data.GetNumberOfPoints() == first.GetNumberOfPoints()
        assert np.array_equal(triangles_of(data), triangles_of(first))
        assert np.array_equal(vtk_to_numpy(data.GetPointData().GetArray("particle")), particle)
    # the surfaces of the last frame enclose the masses and have the centroids of the checkpoint
    x, triangles = points_of(data), triangles_of(data)
    owner = particle[triangles[:, 0]]
    a, b, c = (x[triangles[:, n]] - x[triangles[:, 0]].mean(axis=0) for n in range(3))
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    with h5py.File(whole / "checkpoint.h5") as checkpoint:
        mass, position = checkpoint["particles/mass"][:], checkpoint["particles/position"][:]
        speed = np.linalg.norm(checkpoint["particles/velocity"][:], axis=1)
    for i in range(25):
        mine = owner == i
        volume = volumes[mine].sum()
        moment = (volumes[mine, None] * (a + b + c)[mine] / 4).sum(axis=0)
        assert 2500 * volume == pytest.approx(mass[i], rel=1e-4)  # coordinates are floats: 1e-8 m of 1e-2 m
        assert moment / volume + x[triangles[:, 0]].mean(axis=0) == pytest.approx(position[i], abs=1e-6)
        assert vtk_to_numpy(data.GetPointData().GetArray("speed"))[particle == i] == pytest.approx(speed[i], rel=1e-6)


def test_vtk_reads_walls_and_contacts(whole):
    walls, contacts = Frames(whole / "walls.vtkhdf"), Frames(whole / "contacts.vtkhdf")
    assert len(walls.times) == 16 and len(contacts.times) == 16
    for k, t in enumerate(walls.times):
        data = walls.at(k)
        assert data.GetNumberOfCells() == (24 if t < 0.0105 else 12)
        top = 0.3 * min(max(t - 0.01, 0), 0.01)
        floor = points_of(data)[vtk_to_numpy(data.GetPointData().GetArray("wall")) == 0]
        assert floor[:, 2].max() == pytest.approx(top, abs=1e-7)
    series = series_of(whole)
    for k, t in enumerate(contacts.times):
        row = np.argmin(np.abs(series["time [s]"] - t))
        assert contacts.at(k).GetNumberOfCells() == series["contacts [1]"][row]
    data = contacts.at(15)
    with h5py.File(whole / "checkpoint.h5") as checkpoint:
        bodies, position = checkpoint["contacts/bodies"][:], checkpoint["particles/position"][:]
        force, arm = checkpoint["contacts/normal_force"][:], checkpoint["contacts/arm"][:]
    assert data.GetNumberOfCells() == len(bodies) > 5
    x = points_of(data)
    for c, (i, j) in enumerate(bodies):
        ids = [data.GetCell(c).GetPointId(n) for n in range(data.GetCell(c).GetNumberOfPoints())]
        assert len(ids) == (3 if j < 25 else 2)
        assert x[ids[0]] == pytest.approx(position[i], abs=1e-7)
        assert x[ids[1]] == pytest.approx(position[i] + arm[c], abs=1e-7)
        if j < 25:
            assert x[ids[2]] == pytest.approx(position[j], abs=1e-7)
    shown = vtk_to_numpy(data.GetCellData().GetArray("normal_force"))
    assert np.abs(shown) == pytest.approx(np.linalg.norm(force, axis=1), rel=1e-5)


SLABS = """
name: slabs on an incline
gravity: [{down}, 0, {into}]
time: {{end: 0.8, step: 1e-4}}
materials: [{{name: stone, density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}}]
contact_laws: [{{materials: [stone, stone], friction_coefficient: {friction}, restitution_coefficient: 0.3}}]
shapes:
  - {{name: slab, source: box, size: [0.1, 0.1, 0.02]}}
  - {{name: plate, source: box, size: [4, 1, 0.2]}}
particles: [{{name: slabs, shape: slab, material: stone, bodies: {bodies}}}]
walls: [{{name: plate, shape: plate, material: stone}}]
output: {{series: 0.1, frames: 0.1, checkpoint: 0}}
"""


@pytest.mark.parametrize("friction, num_slabs", [(0.4, 1), (0.7, 2)])
def test_the_forces_of_contacts_are_those_of_statics(tmp_path, friction, num_slabs):
    """A slab slides down an incline of 30 degrees, at the Coulomb limit; two, one on the other, stick to a rougher one."""
    mass, angle, g = 0.5, math.radians(30), 9.81
    bodies = [{"position": [0, 0, 0.11 + 0.02 * k]} for k in range(num_slabs)]
    (tmp_path / "slabs.yaml").write_text(SLABS.format(
        down=g * math.sin(angle), into=-g * math.cos(angle), friction=friction, bodies=json.dumps(bodies)))
    run(tmp_path / "slabs.yaml", "-o", tmp_path / "run")
    data = Frames(tmp_path / "run" / "contacts.vtkhdf").at(8)
    i, j, normal, tangential, slipping = (
        vtk_to_numpy(data.GetCellData().GetArray(name))
        for name in ("i", "j", "normal_force", "tangential_force", "slipping"))
    (foot,) = np.flatnonzero(j == num_slabs)
    slides = friction < math.tan(angle)
    assert i[foot] == 0 and len(i) == num_slabs and list(slipping) == [slides] * num_slabs
    # what is shown is a float, of 6e-8; the slabs have come to rest on the plate as far as it tells
    weight = num_slabs * mass * g
    assert normal[foot] == pytest.approx(weight * math.cos(angle), rel=1e-6)
    assert tangential[foot] == pytest.approx(weight * (friction * math.cos(angle) if slides else math.sin(angle)), rel=1e-6)
    if num_slabs == 2:
        # the upper slab leans by some 1e-4, and its normal with it; the whole force is its weight all the same
        upper = 1 - foot
        assert {i[upper], j[upper]} == {0, 1}
        assert math.hypot(normal[upper], tangential[upper]) == pytest.approx(mass * g, rel=1e-6)
        assert tangential[upper] == pytest.approx(mass * g * math.sin(angle), rel=2e-3)


def test_the_scene_as_used_gives_the_same_run(whole, tmp_path):
    run(whole / "scene.yaml", "-o", tmp_path / "again")
    assert_same_run(whole, tmp_path / "again")


def test_the_scene_as_used_finds_its_mesh_from_any_folder(tmp_path):
    home = tmp_path / "home"
    home.mkdir()
    shutil.copy(MODELS / "l_shape.obj", home / "a stone.obj")
    text = re.sub(r"\{name: rock, source: [^}]*\}", '{name: rock, source: file, file: "a stone.obj"}', SCENE)
    assert "a stone.obj" in text
    (home / "scene.yaml").write_text(text)
    run("home/scene.yaml", "-o", "away/run", "--set", "time.end=1e-3", cwd=tmp_path)
    run(tmp_path / "away/run/scene.yaml", "-o", tmp_path / "again", cwd="/")
    assert_same_run(tmp_path / "away/run", tmp_path / "again")


# ---- stopping and going on


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_stopped_run_tells_how_to_go_on(scene, whole, tmp_path, number, code):
    folder = tmp_path / "it's a run"
    process = start(scene, "-o", folder, "--threads", 1)
    series = folder / "series.csv"
    wait_for(lambda: series.exists() and series.read_text().count("\n") > 8)
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert process.returncode == code, out + err
    assert summary_of(folder)["outcome"] == "interrupted"
    assert 0 < summary_of(folder)["step"] < NUM_STEPS
    command = shlex.split(re.search("^go on with: (.*)$", out, re.M).group(1))
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    assert_same_run(whole, folder)


def test_a_killed_run_goes_on_as_if_nothing_had_been(scene, whole, tmp_path):
    generator = random.Random(7)
    folder = tmp_path / "run"
    arguments = [scene, "-o", folder, "--set", "output.checkpoint=2e-4", "--threads", 1]
    process = start(*arguments)
    wait_for(lambda: (folder / "checkpoint.h5").exists())
    for _ in range(4):
        time.sleep(generator.uniform(0.02, 0.15))
        process.kill()
        process.communicate()
        if not (folder / "frames.vtkhdf").exists():
            break
        # readable as it lies there; VTK does not take one step for steps
        num_frames = len(Frames(folder / "frames.vtkhdf").times)
        with h5py.File(folder / "frames.vtkhdf") as file:
            assert num_frames == len(file["VTKHDF/Steps/Values"]) or (num_frames == 0 and len(file["VTKHDF/Steps/Values"]) == 1)
        process = start(*arguments, "--restart")
    process.kill()
    process.communicate()
    run(*arguments, "--restart")
    assert_same_run(whole, folder)


def test_a_running_run_can_be_looked_at(scene, tmp_path):
    # with HDF5 alone and a frame per step: VTK's reader asks for the number of steps and for the times one after the
    # other, and must not meet a step that is added in between
    process = start(scene, "-o", tmp_path / "run", "--set", "output.frames=5e-5")
    frames = tmp_path / "run" / "frames.vtkhdf"
    wait_for(frames.exists)
    seen = []
    while process.poll() is None:
        with h5py.File(frames, "r", locking=False) as file:
            steps = file["VTKHDF/Steps"]
            seen.append(int(steps.attrs["NSteps"]))
            times = steps["Values"][:]
            assert len(times) >= seen[-1] > 0 and np.all(np.diff(times) > 0)
            first = steps["PointOffsets"][seen[-1] - 1]
            points = file["VTKHDF/Points"][first:first + file["VTKHDF/NumberOfPoints"][2]]
            assert np.all(np.isfinite(points)) and np.ptp(points[:, 0]) > 0.05
    assert process.wait() == 0, process.stderr.read()
    assert seen == sorted(seen) and len(set(seen)) > 3
    assert len(Frames(frames).times) == NUM_STEPS + 1


def test_a_finished_run_can_be_made_longer(scene, tmp_path):
    run(scene, "-o", tmp_path / "long")
    run(scene, "-o", tmp_path / "short", "--set", "time.end=0.02")
    run(scene, "-o", tmp_path / "short", "--restart")
    assert_same_run(tmp_path / "long", tmp_path / "short")
    # at its end there is nothing left to do
    hash_before = summary_of(tmp_path / "short")["state_hash"]
    run(scene, "-o", tmp_path / "short", "--restart")
    assert summary_of(tmp_path / "short")["state_hash"] == hash_before


def test_the_number_of_threads_changes_nothing(scene, whole, tmp_path):
    run(scene, "-o", tmp_path / "run", "--threads", 3)
    assert summary_of(tmp_path / "run")["threads"] == 3
    assert_same_run(whole, tmp_path / "run")


# ---- refusals and failures


@pytest.mark.parametrize("arguments, message", [
    ([], "no scene given"),
    (["--bogus"], "unknown option --bogus"),
    (["a.yaml", "b.yaml"], "one scene at a time"),
    (["a.yaml", "--threads", "0"], "--threads needs a number from 1 to 4096, not 0"),
    (["a.yaml", "--threads"], "--threads needs"),
    (["a.yaml", "--set"], "--set needs"),
    (["a.yaml", "-o"], "-o needs"),
    (["a.yaml", "--restart", "--replace"], "exclude each other"),
    (["missing.yaml"], "missing.yaml"),
])
def test_a_wrong_command_line_is_refused(arguments, message, tmp_path):
    done = run(*arguments, cwd=tmp_path, expect=2)
    assert message in done.stderr and done.stdout == ""
    assert list(tmp_path.iterdir()) == []


def test_a_folder_with_a_run_is_not_written_over(scene, tmp_path):
    short = [scene, "-o", tmp_path / "run", "--set", "time.end=0.001"]
    run(*short)
    (tmp_path / "run" / "notes.txt").write_text("mine")
    before = (tmp_path / "run" / "summary.json").read_bytes()
    done = run(*short, expect=2)
    assert "--restart" in done.stderr and "--replace" in done.stderr
    assert (tmp_path / "run" / "summary.json").read_bytes() == before
    run(*short, "--replace", "--set", "output.frames=0")
    assert (tmp_path / "run" / "notes.txt").read_text() == "mine"
    assert not (tmp_path / "run" / "frames.vtkhdf").exists()


def test_a_restart_needs_a_checkpoint_of_this_scene(scene, tmp_path):
    assert "there is no checkpoint" in run(scene, "-o", tmp_path / "run", "--restart", expect=2).stderr
    run(scene, "-o", tmp_path / "run", "--set", "time.end=0.001")
    before = (tmp_path / "run" / "series.csv").read_bytes()
    for change in ("gravity=[0, 0, -1]", "contact_laws.0.friction_coefficient=0.1", "particles.rocks.count=24",
                   "particles.rocks.seed=5", "time.step=4e-5", "solver.overlap_scheme=hierarchy"):
        done = run(scene, "-o", tmp_path / "run", "--restart", "--set", change, expect=2)
        assert "checkpoint.h5" in done.stderr, change
    assert (tmp_path / "run" / "series.csv").read_bytes() == before


def test_a_folder_is_for_one_run_at_a_time(scene, tmp_path):
    first = start(scene, "-o", tmp_path / "run")
    wait_for((tmp_path / "run" / "frames.vtkhdf").exists)
    done = run(scene, "-o", tmp_path / "run", "--replace", expect=2)
    assert "another run" in done.stderr
    assert first.wait(timeout=60) == 0, first.stderr.read()
    assert len(Frames(tmp_path / "run" / "frames.vtkhdf").times) == 16


def contents_hash_of(checkpoint, names):
    """FNV-1a over the numbers of /now, then all arrays, in the order of docs/format_hdf5.md."""
    def numbers():
        for name in names:
            if name.startswith(("torque_", "force_", "work_")):
                continue  # of walls: in the arrays
            yield np.float64(checkpoint["now"].attrs[name]).tobytes()
        for group, fields in (("particles", PARTICLE_FIELDS), ("contacts", CONTACT_FIELDS), ("walls", WALL_FIELDS)):
            assert set(checkpoint[group]) == set(fields)
            for field in fields:
                yield checkpoint[group][field][:].tobytes()

    basis, value = 0xCBF29CE484222325, 0xCBF29CE484222325
    for byte in b"".join(numbers()):
        value = ((value ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return f"{value ^ basis:016x}".encode()


PARTICLE_FIELDS = """position orientation velocity angular_momentum force torque scale mass inertia shape material
    group""".split()


WALL_FIELDS = "load work marked_work marked_step revolution_power".split()


def documented_contact_fields():
    """The list in the format's page."""
    page = (Path(__file__).resolve().parents[2] / "docs" / "format_hdf5.md").read_text()
    rows = page.split("### /contacts")[1].split("\n#")[0]
    return re.findall(r"^\| `(\w+)` \|", rows, re.M)


CONTACT_FIELDS = documented_contact_fields()


def test_the_hash_of_a_checkpoint_is_as_documented(whole):
    names = [name.split(" ")[0] for name in series_of(whole)]
    with h5py.File(whole / "checkpoint.h5") as checkpoint:
        assert contents_hash_of(checkpoint, names) == checkpoint.attrs["contents_hash"]


def test_an_unstable_run_fails_and_keeps_its_checkpoint(scene, whole, tmp_path):
    # a particle at the end of the range of numbers, in a checkpoint that looks sound: the next step loses it
    run(scene, "-o", tmp_path / "run", "--set", "time.end=0.001")
    names = [name.split(" ")[0] for name in series_of(whole)]
    with h5py.File(tmp_path / "run" / "checkpoint.h5", "r+") as checkpoint:
        checkpoint["particles/position"][3, 2] = 1.7976931348623157e308
        checkpoint["particles/velocity"][3, 2] = 1e308
        checkpoint.attrs["contents_hash"] = np.bytes_(contents_hash_of(checkpoint, names))
    before = (tmp_path / "run" / "checkpoint.h5").read_bytes()
    done = run(scene, "-o", tmp_path / "run", "--restart", expect=1)
    assert "particle 3" in done.stderr and "time.step" in done.stderr and "--replace" in done.stderr
    summary = summary_of(tmp_path / "run")
    assert summary["outcome"] == "failed" and summary["repose_angle_degrees"] is None
    assert summary["energies"]["kinetic"] is None and summary["state_hash"] is None and set(summary["counters"].values()) == {None}
    assert (tmp_path / "run" / "checkpoint.h5").read_bytes() == before


def test_a_time_step_beyond_the_critical_one_is_warned_of(scene, tmp_path):
    done = run(scene, "-o", tmp_path / "run", "--set", "time.step=4e-4")
    assert done.stderr.count("exceeds the critical one of a contact") == 1


def test_a_full_disk_is_told_and_can_be_recovered_from(scene, whole, tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", disk], capture_output=True)
    if mounted.returncode != 0:
        pytest.skip("needs the right to mount a small file system")
    try:
        run(scene, "-o", disk / "run", "--set", "time.end=0.01")
        filler = disk / "filler"
        with open(filler, "wb", buffering=0) as file, pytest.raises(OSError):
            while True:
                file.write(bytes(4096))
        checkpoint = (disk / "run" / "checkpoint.h5").read_bytes()
        done = run(scene, "-o", disk / "run", "--restart", expect=1)
        assert "No space left on device" in done.stderr
        assert (disk / "run" / "checkpoint.h5").read_bytes() == checkpoint
        frames = Frames(disk / "run" / "frames.vtkhdf")
        assert len(frames.times) == 6 and frames.at(5).GetNumberOfPoints() > 0
        assert not list((disk / "run").glob("*.tmp"))
        # room for some more steps, then for all
        os.truncate(filler, filler.stat().st_size - 12288)
        assert "No space left on device" in run(scene, "-o", disk / "run", "--restart", expect=1).stderr
        filler.unlink()
        run(scene, "-o", disk / "run", "--restart")
        assert_same_run(whole, disk / "run")
    finally:
        subprocess.run(["umount", disk], check=True)


def test_a_disk_that_is_full_before_the_first_checkpoint(scene, tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", disk], capture_output=True)
    if mounted.returncode != 0:
        pytest.skip("needs the right to mount a small file system")
    try:
        done = run(scene, "-o", disk / "run", "--set", "output.frames=1e-4", "--set", "output.checkpoint=0", expect=1)
        assert "No space left on device" in done.stderr
        assert not (disk / "run" / "checkpoint.h5").exists()
        assert "there is none from before" in done.stdout and "--restart" not in done.stdout
    finally:
        subprocess.run(["umount", disk], check=True)


# ---- what is printed


def test_output_without_a_terminal_is_plain(scene, tmp_path):
    done = run(scene, "-o", tmp_path / "run", "--set", "time.end=0.002")
    assert done.stdout.startswith('plan of "few rocks"')
    assert "100.0 %" in done.stdout and "finished in" in done.stdout and f"results in {tmp_path}/run" in done.stdout
    assert "\r" not in done.stdout and "\033" not in done.stdout
    quiet = run(scene, "-o", tmp_path / "quiet", "--set", "time.end=0.002", "--quiet")
    assert quiet.stdout == "" and quiet.stderr == ""


def test_progress_on_a_terminal_stays_in_its_line(scene, tmp_path):
    text, code = on_terminal([PROGRAM, "run", scene, "-o", tmp_path / "run"])
    assert code == 0
    assert re.search(r"\r\[#*\.*\] +[0-9.]+ %  t [0-9.e-]+ s  left .* steps/s  [0-9]+ contacts  E_kin [^ ]+ J\033\[K", text)


def test_the_default_folder_is_named_after_the_scene(scene, tmp_path):
    run(scene, "--set", "time.end=0.001", cwd=tmp_path)
    assert summary_of(tmp_path / "runs" / "few rocks")["outcome"] == "finished"


@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="one processor: waiting threads do not spin there")
@pytest.mark.parametrize("policy, is_warned", [("active", True), ("passive", False)])
def test_threads_on_a_shared_machine_are_warned_of(scene, tmp_path, policy, is_warned):
    two = list(os.sched_getaffinity(0))[:2]
    sharing = {"preexec_fn": lambda: os.sched_setaffinity(0, two)}
    changes = ["particles.rocks.count=1000", "particles.rocks.size.min=0.003", "particles.rocks.size.max=0.004",
               "time.step=auto", "time.end=1000"]
    command = [PROGRAM, "run", str(scene), "-o", str(tmp_path / "run"), "--threads", "2", "--quiet"]
    command += [word for change in changes for word in ("--set", change)]
    told = tmp_path / "told.txt"
    others = [subprocess.Popen(["sh", "-c", "while :; do :; done"], **sharing) for _ in range(4)]
    try:
        with told.open("w") as out:
            process = subprocess.Popen(command, stderr=out, env=dict(os.environ, OMP_WAIT_POLICY=policy), **sharing)
        end = time.monotonic() + (60 if is_warned else 8)
        while process.poll() is None and time.monotonic() < end and told.stat().st_size == 0:
            time.sleep(0.1)
        process.terminate()
        assert process.wait() == 143
    finally:
        for other in others:
            other.kill()
            other.wait()
    assert ("OMP_WAIT_POLICY=passive" in told.read_text()) == is_warned


def test_a_body_that_is_shot_into_another_is_warned_of(tmp_path):
    """A cube that is wholly inside another after one step: there is no force, and the run says so, once."""
    cubes = ["{name: large, shape: large, material: stone, bodies: [{position: [0, 0, 0]}]}",
             "{name: small, shape: small, material: stone, bodies: [{position: [0.14, 0, 0], velocity: [-100, 0, 0]}]}"]
    for order in (0, 1):
        path = tmp_path / f"scene{order}.yaml"
        path.write_text(
            "name: shot\ngravity: [0, 0, 0]\ntime: {end: 1e-3, step: 5e-4}\n"
            "materials: [{name: stone, density: 2500, youngs_modulus: 1e5, poisson_ratio: 0.25}]\n"
            "contact_laws: [{materials: [stone, stone], friction_coefficient: 0.5, damping_ratio: 0}]\n"
            "shapes: [{name: large, source: box, size: 0.2}, {name: small, source: box, size: 0.01}]\n"
            f"particles: [{cubes[order]}, {cubes[1 - order]}]\n"
        )
        done = subprocess.run([PROGRAM, "run", path, "-o", tmp_path / f"run{order}"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert done.stderr.count("a polyhedron is inside another body, or goes through it") == 1
        summary = json.loads((tmp_path / f"run{order}" / "summary.json").read_text())
        assert summary["counters"]["without_normal"] == 2 and summary["counters"]["contacts"] == 0
