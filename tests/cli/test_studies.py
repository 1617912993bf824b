"""tools/studies: all studies or those named, failures told, quick ones in a copy. On studies made up here."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TOOL = Path(__file__).resolve().parents[2] / "tools" / "studies"
STUDY = """
import os
from pathlib import Path
here = Path(__file__).resolve().parent
assert (here.parent.parent / "scenes" / "a.yaml").exists()
Path("README.md").write_text(here.name + " " + os.environ.get("QUICK", "whole"))
"""


@pytest.fixture
def tree(tmp_path):
    """A tree with a tool, a scene and two studies, `bad` of which fails."""
    for name in ("tools", "scenes", "validation/good", "validation/bad", ".venv/bin"):
        (tmp_path / name).mkdir(parents=True)
    shutil.copy(TOOL, tmp_path / "tools" / "studies")
    (tmp_path / ".venv/bin/python").symlink_to(sys.executable)
    (tmp_path / "scenes/a.yaml").write_text("name: a\n")
    (tmp_path / "validation/good/run.py").write_text(STUDY)
    (tmp_path / "validation/good/README.md").write_text("before")
    (tmp_path / "validation/bad/run.py").write_text("raise SystemExit(1)\n")
    return tmp_path


def studies(tree, *names, **more):
    return subprocess.run([tree / "tools" / "studies", *names], env=os.environ | more, capture_output=True, text=True)


def test_a_named_study_makes_its_page(tree):
    done = studies(tree, "good", QUICK="")
    assert done.returncode == 0, done.stderr
    assert (tree / "validation/good/README.md").read_text().startswith("good")
    assert not (tree / "runs").exists()


def test_all_are_run_and_the_one_that_fails_is_named(tree):
    done = studies(tree, QUICK="")
    assert done.returncode == 1 and "failed: bad" in done.stderr
    assert (tree / "validation/good/README.md").read_text().startswith("good")


def test_a_quick_study_leaves_the_page_of_the_whole_one(tree):
    done = studies(tree, "good", QUICK="1")
    assert done.returncode == 0, done.stderr
    assert (tree / "validation/good/README.md").read_text() == "before"
    quick = tree / "runs/quick/validation/good/README.md"
    assert quick.read_text() == "good 1" and str(quick) in done.stdout


def test_a_study_that_is_not_there_is_refused(tree):
    done = studies(tree, "nowhere", QUICK="")
    assert done.returncode == 1 and "no validation/nowhere/run.py" in done.stderr
