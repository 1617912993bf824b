"""scree check and the front of the program: exit codes, what goes where, every scene that comes with scree."""

import os
import pathlib
import random
import re
import subprocess

import pytest

ROOT = pathlib.Path(os.environ.get("SCREE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
PROGRAM = os.environ.get("SCREE_PROGRAM", str(ROOT / "build/release/scree"))
SCENES = sorted((ROOT / "scenes").glob("*.yaml"))


def scree(*arguments, **options):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)], capture_output=True, text=True, errors="replace", timeout=300, **options
    )


def scene(name):
    return ROOT / "scenes" / f"{name}.yaml"


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_every_scene_is_right(path):
    result = scree("check", path)
    assert result.returncode == 0, result.stderr
    assert f'plan of "{path.stem}"' in result.stdout
    # a scene that others start from warns of nothing
    assert result.stderr == ""


def test_there_are_scenes():
    assert {"two_spheres", "block_on_incline", "cube_tower", "gravity_packing", "free_cloud"} <= {p.stem for p in SCENES}


def test_numbers_of_the_plan():
    result = scree("check", scene("cube_tower"))
    # ten cubes of 0.1 m and 2500 kg/m^3
    assert "particles 10, mass 25 kg" in result.stdout
    assert "20000 steps of 0.0001 s" in result.stdout
    step, share, critical, suggested = map(
        float,
        re.search(r"time step (\S+) s, (\S+) of the critical step of (\S+) s; suggested (\S+) s", result.stdout).groups(),
    )
    assert step == 1e-4
    assert share == pytest.approx(step / critical, rel=1e-2)  # printed with three digits
    assert suggested == pytest.approx(0.5 * critical, rel=1e-3)


def test_numbers_of_groups():
    out = scree("check", scene("mixture")).stdout
    total, mass = re.search(r"particles (\d+), mass (\S+) kg", out).groups()
    groups = re.findall(r'^ {4}"(\w+)" (\d+), mass (\S+) kg$', out, re.M)
    assert [(name, number) for name, number, _ in groups] == [("rocks", "300"), ("balls", "200"), ("cubes", "100")]
    assert int(total) == 600
    assert float(mass) == pytest.approx(sum(float(one) for _, _, one in groups), rel=1e-5)
    # spheres of 10 mm and 2500 kg/m^3, cubes of 10 mm and 2600 kg/m^3
    assert float(groups[1][2]) == pytest.approx(200 * 2500 * 3.141592653589793 / 6 * 1e-6, rel=1e-5)
    assert float(groups[2][2]) == pytest.approx(100 * 2600 * 1e-6, rel=1e-5)


def test_set_changes_the_scene():
    result = scree("check", scene("gravity_packing"), "--set", "particles.fall.count=100", "--set=time.end=0.5")
    assert result.returncode == 0, result.stderr
    assert "particles 100, mass" in result.stdout
    assert "50000 steps of 1e-05 s" in result.stdout


def test_a_gpu_that_is_not_there_is_no_fault_of_the_scene():
    where = {"env": {**os.environ, "CUDA_VISIBLE_DEVICES": ""}}
    result = scree("check", scene("cube_tower"), "--device", "cuda", **where)
    assert result.returncode == 1 and 'plan of "cube_tower"' in result.stdout
    assert "cube_tower.yaml: no fault found in the scene, but it cannot run on cuda:0 here" in result.stderr
    assert "refused" not in result.stderr
    result = scree("check", scene("cube_tower"), "--device", "cuda", "--set", "time.end=-1", **where)
    assert result.returncode == 2 and "refused, 1 fault" in result.stderr and "cuda" not in result.stderr


def test_print_fills_in_defaults_and_reads_the_same(tmp_path):
    first = scree("check", "--print", scene("free_cloud"), "--set", "time.end=0.125")
    assert first.returncode == 0
    assert "end: 0.125" in first.stdout and "tangential_spring: 1" in first.stdout
    copy = tmp_path / "copy.yaml"
    copy.write_text(first.stdout)
    second = scree("check", "--print", copy)
    assert second.returncode == 0 and second.stderr == ""
    assert second.stdout == first.stdout


def test_all_faults_are_told(tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text(
        "time: {end: -1}\n"
        "materials:\n"
        "  - {name: rock, desnity: 2700, youngs_modulus: 2e7, poisson_ratio: 0.75}\n"
        "particles:\n"
        "  - {name: one, shape: cube, material: rok, bodies: [{position: [0, 0, 0]}]}\n"
    )
    result = scree("check", path)
    assert result.returncode == 2
    assert result.stdout == ""
    for part in (
        "bad.yaml:1: end of time is -1; it must be a number in [0, 1e+09] s",
        'bad.yaml:3: "desnity" is no key of materials.0; did you mean "density"?',
        "bad.yaml:3: density of materials.0 is missing",
        "bad.yaml:3: poisson_ratio of materials.0 is 0.75",
        'bad.yaml:5: shape of particles.0 is "cube", but there are no shapes',
        'bad.yaml:5: material of particles.0 is "rok", which is not among the materials; did you mean "rock"?',
        "refused, 6 faults",
    ):
        assert part in result.stderr


def test_faults_that_need_the_meshes():
    overlapping = scree("check", scene("cube_tower"), "--set", "particles.tower.bodies.1.position.2=0.1")
    assert overlapping.returncode == 2
    assert "starts" in overlapping.stderr and "inside" in overlapping.stderr
    crowded = scree("check", scene("free_cloud"), "--set", "particles.left.count=100000")
    assert crowded.returncode == 2
    assert "100000 are asked for" in crowded.stderr


@pytest.mark.parametrize("still", ["lifters", "drum"])
def test_a_mill_whose_lifters_do_not_turn_with_it(still):
    """The slip of one key: the shell would turn away from the lifters that it holds."""
    result = scree("check", scene("tumbling_mill"), "--set", f"walls.{still}.motion.kind=fixed", "--set",
                   "fields.measure=false")
    assert result.returncode == 2
    assert 'walls "drum" and "lifters" reach into each other, but move differently' in result.stderr


@pytest.mark.parametrize(
    "content, message",
    [
        (b"", "there is nothing in it"),
        (b"\x7fELF\x02\x01\x01\x00\x00", "a scene is a plain text in UTF-8"),
        (random.Random(3).randbytes(5000), "bad.yaml"),
        (b"time:\n  end: 1\n\tstep: 1\n", "bad.yaml:3:1: "),
    ],
    ids=["empty", "binary", "noise", "tab"],
)
def test_files_that_are_no_scenes(tmp_path, content, message):
    path = tmp_path / "bad.yaml"
    path.write_bytes(content)
    result = scree("check", path)
    assert result.returncode == 2
    assert message in result.stderr and result.stdout == ""


def test_files_that_cannot_be_read(tmp_path):
    for path, message in ((tmp_path / "none.yaml", "there is no such file"), (tmp_path, "this is a folder")):
        result = scree("check", path)
        assert result.returncode == 2 and message in result.stderr
    large = tmp_path / "large.yaml"
    with large.open("wb") as stream:
        stream.truncate(100_000_000)
    result = scree("check", large)
    assert result.returncode == 2 and "more than 64 MB" in result.stderr


@pytest.mark.parametrize(
    "arguments, message",
    [
        ([], "usage: scree COMMAND"),
        (["chek"], 'unknown command "chek"; did you mean "check"?'),
        (["frobnicate"], 'unknown command "frobnicate"; see scree --help'),
        (["--versoin"], 'unknown option "--versoin"; did you mean "--version"?'),
        (["help", "sceen"], 'unknown topic "sceen"; did you mean "scene"?'),
        (["check"], "no scene given"),
        (["check", "a.yaml", "b.yaml"], "one scene at a time"),
        (["check", "--prnt", "a.yaml"], "unknown option --prnt"),
        (["check", "a.yaml", "--set"], "--set needs PATH=VALUE"),
    ],
)
def test_wrong_command_lines(arguments, message):
    result = scree(*arguments)
    assert result.returncode == 2
    assert message in result.stderr and result.stdout == ""


def test_help_and_version():
    version = re.search(r'SCREE_VERSION "([0-9.]+)"', (ROOT / "include/scree/base.h").read_text()).group(1)
    assert scree("--version").stdout == f"scree {version}\n"
    assert scree("check", "--version").stdout == f"scree {version}\n"
    assert "usage: scree COMMAND" in scree("--help").stdout
    for command in ("run", "check", "shape", "overlap"):
        result = scree(command, "--help")
        assert result.returncode == 0 and f"usage: scree {command}" in result.stdout
    assert scree("help", "check").stdout == scree("check", "--help").stdout
    assert scree("--help", "scene").stdout == (ROOT / "docs/scenes.md").read_text()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")
@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["check", "--help"], ["check", scene("two_spheres")]])
def test_output_that_cannot_be_written_is_a_failure(arguments):
    with open("/dev/full", "w") as full:
        result = subprocess.run(
            [PROGRAM, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60
        )
    assert result.returncode == 1 and "could not be written" in result.stderr
