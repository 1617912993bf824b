"""scree shape: measures, refusals, simplification and output, on the command line."""
import json
import math
import os
import pathlib
import subprocess

import pytest

SCREE = os.environ["SCREE_PROGRAM"]
MODELS = pathlib.Path(__file__).resolve().parents[2] / "models"

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


def run(*arguments):
    return subprocess.run([SCREE, "shape", *map(str, arguments)], capture_output=True, text=True, timeout=60)


def shapes(*arguments, code=0):
    done = run("--json", *arguments)
    assert done.returncode == code, done.stderr
    return json.loads(done.stdout)


def test_box_in_json():
    (box,) = shapes("--generate", "box:1:2:3")
    assert box["is_valid"] and box["is_convex"] and box["messages"] == []
    assert (box["num_triangles"], box["num_vertices"], box["num_pieces"], box["euler_characteristic"]) == (12, 8, 1, 2)
    assert box["volume"] == pytest.approx(6, rel=1e-14) and box["area"] == pytest.approx(22, rel=1e-14)
    assert box["box_lower"] == [-0.5, -1, -1.5] and box["box_upper"] == [0.5, 1, 1.5]
    assert box["middle_size"] == 2 and box["bounding_radius"] == pytest.approx(math.sqrt(3.5))
    assert box["principal_moments"] == pytest.approx([6.5, 5, 2.5]) and box["principal_axes"] == [1, 0, 0, 0]
    assert box["edge_range"] == pytest.approx([1, math.sqrt(13)]) and box["import_rounding"] == 0


@pytest.mark.parametrize("specification", ["sphere:1", "sphere:1:0"])
def test_a_true_sphere_has_no_mesh(specification):
    done = run("--generate", specification)
    assert done.returncode == 2 and "a true sphere has no mesh" in done.stderr


def test_models_are_valid_with_the_volumes_of_their_plans():
    results = {pathlib.Path(r["name"]).stem: r for r in shapes(*sorted(MODELS.glob("*.obj")))}
    assert set(results) >= {"l_shape", "u_shape", "ring", "rock"}
    assert all(r["is_valid"] and not r["is_convex"] for r in results.values())
    assert results["l_shape"]["volume"] == pytest.approx((0.375 + 0.375 * 0.625) * 0.375, rel=1e-12)
    assert results["u_shape"]["volume"] == pytest.approx((0.3125 + 2 * 0.3125 * 0.6875) * 0.3125, rel=1e-12)
    # a polygon of n corners has the area n/2 r^2 sin(2 pi/n); coordinates are rounded to six digits
    polygons = 8 * math.sin(math.pi / 8) * (0.5**2 - 0.25**2)
    assert results["ring"]["volume"] == pytest.approx(polygons * 0.25, rel=1e-5)
    assert results["ring"]["euler_characteristic"] == 0
    assert results["rock"]["num_triangles"] == 1000 and results["rock"]["middle_size"] == pytest.approx(1, abs=1e-6)


def test_text_tells_what_was_rounded_and_mended(tmp_path):
    mesh = tmp_path / "inverted.obj"
    mesh.write_text(TETRAHEDRON.replace("f 1 3 2", "f 1 2 3").replace("f 1 2 4", "f 1 4 2")
                    .replace("f 2 3 4", "f 2 4 3").replace("f 3 1 4", "f 3 4 1"))
    done = run(mesh)
    assert done.returncode == 0
    assert "closed, oriented outwards, no self-intersection" in done.stdout
    assert "read in single precision" in done.stdout
    assert "inside out and was turned" in done.stderr
    (result,) = shapes(mesh)
    assert result["volume"] == pytest.approx(1 / 6) and "inside out" in result["messages"][0]


def test_simplify_scale_and_write(tmp_path):
    out = tmp_path / "small.obj"
    (made,) = shapes("--generate", "rock:3:1000", "--simplify", 60, "--volume", 2.5, "-o", out)
    assert abs(made["num_triangles"] - 60) <= 6 and made["volume"] == pytest.approx(2.5, rel=1e-12)
    (read,) = shapes(out)
    assert read["num_triangles"] == made["num_triangles"]
    assert read["volume"] == pytest.approx(2.5, rel=10 * read["import_rounding"])
    assert list(tmp_path.iterdir()) == [out]


def test_refusals_name_the_place_and_the_others_go_on(tmp_path):
    opened = tmp_path / "open.obj"
    opened.write_text(TETRAHEDRON.replace("f 3 1 4\n", ""))
    first, second = shapes(opened, "--generate", "tetrahedron:1", code=2)
    assert not first["is_valid"] and "volume" not in first
    assert any("(0, 0, 0) and" in m and "(0, 1, 0) has triangle" in m and "hole" in m for m in first["messages"])
    assert second["is_valid"]
    done = run(opened)
    assert done.returncode == 2 and "refused" in done.stdout and "open.obj: the edge of vertices" in done.stderr


def test_files_that_cannot_be_read_or_written(tmp_path):
    assert run(tmp_path / "missing.obj").returncode == 1
    assert run("--generate", "box:1:1:1", "-o", tmp_path / "none" / "box.obj").returncode == 1
    done = run(MODELS / "ring.obj", "--simplify", 4)
    assert done.returncode == 2 and "ask for more" in done.stderr


@pytest.mark.parametrize("arguments, text", [
    ([], "no mesh given"),
    (["--bad"], "unknown option --bad"),
    (["--simplify"], "needs a value"),
    (["--simplify", "3", "x.obj"], "whole number >= 4"),
    (["--simplify", "10x", "x.obj"], "whole number >= 4"),
    (["--volume", "-1", "x.obj"], "must be a number > 0"),
    (["--volume", "nan", "x.obj"], "must be a number > 0"),
    (["a.obj", "b.obj", "-o", "c.obj"], "-o takes one mesh"),
    (["--generate", "rock:1"], "rock:SEED:N"),
    (["--generate", "box:1:0:1"], "box:X:Y:Z"),
])
def test_wrong_command_lines(arguments, text):
    done = run(*arguments)
    assert done.returncode == 2 and text in done.stderr


def test_help():
    done = run("--help")
    assert done.returncode == 0 and done.stdout.startswith("usage: scree shape") and done.stderr == ""
