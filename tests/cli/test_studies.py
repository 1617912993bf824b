"""tools/studies and validation/study.py: all studies or those named, failures told, quick ones elsewhere, broken-off ones gone on
with. On studies made up here."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = os.environ.get("SCREE_BUILD_DIR", str(ROOT / "build" / "release"))
STUDY = """
import sys
from pathlib import Path
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import QUICK, Study, in_parallel, write_scene

STUDY = Study(__file__)
STEPS = 400 if QUICK else 2500
SCENE = {
    "name": "a fall", "time": {"end": STEPS * 1e-4, "step": 1e-4},
    "materials": [{"name": "stone", "density": 2500, "youngs_modulus": 1e7, "poisson_ratio": 0.25}],
    "contact_laws": [{"materials": ["stone", "stone"], "friction_coefficient": 0.4, "damping_ratio": 0.3}],
    "shapes": [{"name": "rock", "source": "rock", "triangles": 40, "seed": 1}],
    "particles": [{"name": "rocks", "shape": "rock", "material": "stone", "count": 200, "seed": 1,
                   "size": {"distribution": "fixed", "mean": 0.01}, "region": {"min": [0, 0, 0], "max": [0.2, 0.2, 0.2]}}],
    "output": {"series": 0.01, "frames": 0, "checkpoint": 1e-3},
}


def compute():
    def run(seed):
        scene = write_scene(STUDY.runs / f"{seed}.yaml", SCENE)
        return STUDY.run(scene, f"seed {seed}", [f"particles.rocks.seed={seed}"])

    in_parallel(run, [1, 2, 3])
    return {"hashes": [run(seed).summary()["state_hash"] for seed in (1, 2, 3)]}


STUDY.main(compute, lambda results: {"hashes": " ".join(results["hashes"]), "steps": str(STEPS)})
"""
PAGE = "# A fall\n{{steps}} steps: {{hashes}}, engine {{commit}}\n"


@pytest.fixture
def tree(tmp_path):
    """A tree with the tools and two studies, `bad` of which fails."""
    shutil.copytree(ROOT / "tools", tmp_path / "tools")
    for name in ("validation/good", "validation/bad", ".venv/bin"):
        (tmp_path / name).mkdir(parents=True)
    shutil.copy(ROOT / "validation" / "study.py", tmp_path / "validation")
    python = tmp_path / ".venv/bin/python"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    (tmp_path / "validation/good/run.py").write_text(STUDY)
    (tmp_path / "validation/good/page.md").write_text(PAGE)
    (tmp_path / "validation/good/README.md").write_text("before")
    (tmp_path / "validation/bad/run.py").write_text("raise SystemExit(1)\n")
    return tmp_path


def environment(**more):
    return os.environ | {"SCREE_BUILD_DIR": PROGRAMS, "QUICK": ""} | more


def studies(tree, *names, **more):
    return subprocess.run([tree / "tools" / "studies", *names], env=environment(**more), capture_output=True, text=True, timeout=300)


def test_all_are_run_and_the_one_that_fails_is_named(tree):
    done = studies(tree)
    assert done.returncode == 1 and "failed: bad" in done.stderr, done.stderr
    hashes = json.loads((tree / "validation/good/results.json").read_text())["hashes"]
    assert len(set(hashes)) == 3
    assert (tree / "validation/good/README.md").read_text() == f"# A fall\n2500 steps: {' '.join(hashes)}, engine unknown\n"
    assert not (tree / "runs/quick").exists()


def test_a_quick_study_writes_into_its_own_folder_alone(tree):
    before = {path: path.read_bytes() for path in tree.rglob("*") if path.is_file()}
    done = studies(tree, "good", QUICK="1")
    assert done.returncode == 0, done.stderr
    quick = tree / "runs/quick/good/README.md"
    assert "QUICK=1" in quick.read_text() and "\n400 steps: " in quick.read_text() and str(quick) in done.stdout
    after = {path: path.read_bytes() for path in tree.rglob("*") if path.is_file() and tree / "runs/quick" not in path.parents}
    assert after == before


def test_a_study_that_is_not_there_is_refused(tree):
    done = studies(tree, "nowhere")
    assert done.returncode == 1 and "no validation/nowhere/run.py" in done.stderr


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_a_killed_study_goes_on(tree, how):
    """The runs of a killed study are waited for or gone on with, and the numbers are those of an unbroken one."""
    script = [sys.executable, "-B", tree / "validation/good/run.py"]
    process = subprocess.Popen(script, env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    runs = tree / "runs/good"
    deadline = time.monotonic() + 60
    while not list(runs.glob("seed */only/checkpoint.h5")):
        assert process.poll() is None and time.monotonic() < deadline
        time.sleep(0.01)
    process.send_signal(how)
    process.wait(timeout=60)
    if how == signal.SIGTERM:
        outcomes = [json.loads(path.read_text())["outcome"] for path in runs.glob("seed */only/summary.json")]
        assert "finished" not in outcomes, "runs went on after the signal"
    assert (tree / "validation/good/README.md").read_text() == "before"
    again = studies(tree, "good")
    assert again.returncode == 0, again.stderr
    broken = json.loads((tree / "validation/good/results.json").read_text())
    shutil.rmtree(runs)
    assert studies(tree, "good").returncode == 0
    assert json.loads((tree / "validation/good/results.json").read_text()) == broken


def test_runs_of_another_engine_are_not_mixed_in(tree):
    assert studies(tree, "good", QUICK="1").returncode == 0
    (tree / "runs/quick/good/runs/engine.txt").write_text("0123456\n")
    done = studies(tree, "good", QUICK="1")
    assert done.returncode == 1 and "commit 0123456, now unknown" in done.stderr and "delete that folder" in done.stderr


def test_a_text_that_is_not_made_is_refused(tree):
    (tree / "validation/good/page.md").write_text(PAGE + "{{missing}}\n")
    done = studies(tree, "good", QUICK="1")
    assert done.returncode == 1 and "{{missing}}" in done.stderr


def test_runs_of_another_scene_are_not_mixed_in(tree):
    assert studies(tree, "good", QUICK="1").returncode == 0
    script = tree / "validation/good/run.py"
    script.write_text(script.read_text().replace('"count": 200', '"count": 100'))
    done = studies(tree, "good", QUICK="1")
    assert done.returncode == 1 and "another scene" in done.stderr and str(tree / "runs/quick/good/runs") in done.stderr
