"""scree overlap: single pairs, batches, faults. Compared with closed forms."""
import json
import math
import os
import subprocess

import pytest

SCREE = os.environ["SCREE_PROGRAM"]

BOX_TRIANGLES = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4],
                 [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]]


def box(lower, upper):
    (a, b, c), (d, e, f) = lower, upper
    vertices = [[a, b, c], [d, b, c], [d, e, c], [a, e, c], [a, b, f], [d, b, f], [d, e, f], [a, e, f]]
    return {"vertices": vertices, "triangles": BOX_TRIANGLES}


def run(*arguments, text=None):
    return subprocess.run([SCREE, "overlap", *map(str, arguments)], input=text, capture_output=True, text=True, timeout=60)


def batch(cases, *arguments):
    lines = "\n".join(c if isinstance(c, str) else json.dumps(c) for c in cases)
    done = run("--batch", "-", *arguments, text=lines)
    return done, [json.loads(line) for line in done.stdout.splitlines()]


def test_shifted_boxes_of_a_batch():
    cases = [{"id": f"shift {k}", "a": box((0, 0, 0), (1, 1, 1)), "b": box((0.5, 0.25, 1 - 2.0**-k), (2, 2, 2))}
             for k in range(1, 30)]
    done, results = batch(cases)
    assert done.returncode == 0 and [r["id"] for r in results] == [c["id"] for c in cases]
    for k, r in enumerate(results, start=1):
        h = 2.0**-k
        eps = 10 * 2.0**-52
        assert r["status"] == "touching"
        assert abs(r["volume"] - 0.5 * 0.75 * h) <= eps
        assert r["centroid"] == pytest.approx([0.75, 0.625, 1 - h / 2], abs=1e-9)
        # A's top, its +x and its +y face reach into B
        area = [0.75 * h, 0.5 * h, 0.375]
        assert r["area_vector"] == pytest.approx(area, abs=1e-9)
        length = math.sqrt(sum(x * x for x in area))
        normal = [x / length for x in area]
        assert r["normal"] == pytest.approx(normal, abs=1e-9)
        extent = 0.5 * normal[0] + 0.75 * normal[1] + h * normal[2]
        assert r["indentation"] == pytest.approx(extent, abs=1e-9)
        assert r["residual"] < 1e-6


def joined(*bodies):
    """Disjoint bodies as one."""
    whole = {"vertices": [], "triangles": []}
    for body in bodies:
        first = len(whole["vertices"])
        whole["vertices"] += body["vertices"]
        whole["triangles"] += [[first + i for i in t] for t in body["triangles"]]
    return whole


def test_patches():
    legs = joined(box((0, 0, 0), (1, 1, 2)), box((3, 0, 0.25), (5, 1, 2)))
    case = {"id": "legs", "a": legs, "b": box((-1, -1, -1), (6, 2, 0.5))}
    done, (r,) = batch([case], "--patches")
    assert done.returncode == 0 and len(r["patches"]) == 2
    left, right = sorted(r["patches"], key=lambda p: p["centroid"][0])
    assert left["volume"] == pytest.approx(0.5, abs=1e-14) and right["volume"] == pytest.approx(0.5, abs=1e-14)
    assert left["centroid"] == pytest.approx([0.5, 0.5, 0.25], abs=1e-12)
    assert right["centroid"] == pytest.approx([4, 0.5, 0.375], abs=1e-12)
    assert left["indentation"] == pytest.approx(0.5, abs=1e-12) and right["indentation"] == pytest.approx(0.25, abs=1e-12)
    _, (merged,) = batch([case])
    assert "patches" not in merged and merged["volume"] == pytest.approx(r["volume"], abs=1e-14)


def test_numbers_have_17_digits():
    third = 1.0 / 3.0
    _, (r,) = batch([{"id": 1, "a": box((0, 0, 0), (1, 1, 1)), "b": box((third, third, third), (2, 2, 2))}])
    assert len(repr(r["volume"])) > 15 and abs(r["volume"] - (1 - third) ** 3) < 1e-15


def test_poses_of_mesh_files(tmp_path):
    made = subprocess.run([SCREE, "shape", "--generate", "box:1:1:1", "-o", str(tmp_path / "cube.obj")],
                          capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    half = math.sqrt(0.5)
    cases = tmp_path / "cases.jsonl"
    cases.write_text(json.dumps({"id": "turned", "a": {"mesh": "cube.obj"},
                                 "b": {"mesh": "cube.obj", "scale": 2, "position": [0, 0, 1.4],
                                       "orientation": [half, 0, 0, half]}}) + "\n")
    done = run("--batch", cases, "-o", tmp_path / "out.jsonl")
    assert done.returncode == 0, done.stderr
    r = json.loads((tmp_path / "out.jsonl").read_text())
    assert r["volume"] == pytest.approx(0.1, abs=1e-14) and r["normal"] == pytest.approx([0, 0, 1], abs=1e-9)


def test_faults_of_single_cases_do_not_stop_the_others():
    good = {"id": "good", "a": box((0, 0, 0), (1, 1, 1)), "b": box((0.5, 0.5, 0.5), (2, 2, 2))}
    open_mesh = {"id": "open", "a": {**box((0, 0, 0), (1, 1, 1)), "triangles": BOX_TRIANGLES[1:]}, "b": good["b"]}
    index = {"id": "index", "a": {**good["a"], "triangles": [[0, 1, 99]]}, "b": good["b"]}
    missing = {"id": "file", "a": {"mesh": "no_such_file.obj"}, "b": good["b"]}
    done, results = batch([good, open_mesh, '{"id": "broken", ', index, missing, '[1, 2]', good,
                           '{"id": "nan", "a": {"vertices": [[NaN, 0, 0]], "triangles": []}, "b": {}}'])
    assert done.returncode == 1
    assert [r["status"] for r in results] == ["touching", "error", "error", "error", "error", "error", "touching", "error"]
    assert [r["id"] for r in results][:2] == ["good", "open"] and results[3]["id"] == "index"
    assert "line 3" in results[2]["message"]
    assert "triangles[0]" in results[3]["message"] and "[0, 7]" in results[3]["message"]
    assert "no_such_file.obj" in results[4]["message"]


def test_disjoint_nested_and_touching():
    a = box((0, 0, 0), (1, 1, 1))
    _, results = batch([{"id": 1, "a": a, "b": box((2, 0, 0), (3, 1, 1))},
                        {"id": 2, "a": a, "b": box((0.25, 0.25, 0.25), (0.75, 0.75, 0.75))},
                        {"id": 3, "a": a, "b": box((1, 0, 0), (2, 1, 1))}])
    assert results[0]["status"] == "none" and results[0]["volume"] == 0
    assert results[1]["status"] == "no_normal" and results[1]["normal"] is None
    assert results[1]["volume"] == pytest.approx(0.125, abs=1e-15)
    assert results[2]["volume"] == pytest.approx(0, abs=10 * 2.0**-52)


def test_single_pair_for_people_and_programs():
    arguments = ["box:1:1:1", "box:1:1:1", "--position-b", "0,0,0.75"]
    done = run(*arguments)
    assert done.returncode == 0 and "touching" in done.stdout and "0.25 m^3" in done.stdout
    done = run(*arguments, "--json")
    assert json.loads(done.stdout)["volume"] == 0.25
    assert run(*arguments, "--json", "--scheme", "hierarchy").stdout == done.stdout


def test_command_line_is_checked():
    for arguments, message in [(["box:1:1:1"], "1 meshes given"), (["--bad", "a", "b"], "unknown option --bad"),
                               (["box:1:1:1", "box:1:1:1", "--scale-a", "0"], "a number > 0"),
                               (["box:1:1:1", "box:1:1:1", "--position-a", "1,2"], "three numbers"),
                               (["box:1:1:1", "box:1:1:1", "--scheme", "guess"], "filtered or hierarchy"),
                               (["box:1:1", "box:1:1:1"], "not a shape that can be made")]:
        done = run(*arguments)
        assert done.returncode == 2 and message in done.stderr, done.stderr
    assert run("nothing.obj", "box:1:1:1").returncode in (1, 2)
    assert run("--help").returncode == 0
