"""Pages say what is so: links lead somewhere, names of the notation exist, the README's scene and commands work."""

import os
import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(os.environ.get("SCREE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
PROGRAM = os.environ.get("SCREE_PROGRAM", str(ROOT / "build/release/scree"))
PAGES = sorted(
    page
    for page in ROOT.rglob("*.md")
    if not {"build", ".venv", "runs", ".git"} & set(page.relative_to(ROOT).parts)
)


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
        if not re.match(r"[a-z]+:", target):
            assert (page.parent / target).exists(), f"{page.name} links to {target}, which is not there"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_named_files_exist(page):
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    folders = "include|src|scenes|models|tests|tools|docs|cmake|validation|benchmarks|examples"
    for path in re.findall(rf"`((?:{folders})/[\w./-]*\w)`", text):
        assert (ROOT / path).exists(), f"{page.name} names {path}, which is not there"


def test_notation_names_exist():
    sources = "\n".join(
        path.read_text() for folder in ("include", "src") for path in (ROOT / folder).rglob("*.[ch]")
    )
    words = set(re.findall(r"\w+", sources))
    for line in (ROOT / "docs/notation.md").read_text().splitlines():
        if line.startswith("| ") and "`" in line:
            for name in re.findall(r"`(\w+)`", line.split(" | ")[1]):
                assert name in words, f"docs/notation.md names {name}, which the code does not use"


def test_readme_scene_is_accepted(tmp_path):
    (scene,) = blocks(ROOT / "README.md", "yaml")
    (tmp_path / "first.yaml").write_text(scene)
    result = subprocess.run([PROGRAM, "check", tmp_path / "first.yaml"], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    broken = scene.replace("density: 2700", "density: -2700")
    (tmp_path / "broken.yaml").write_text(broken)
    assert subprocess.run([PROGRAM, "check", tmp_path / "broken.yaml"], capture_output=True).returncode != 0


def test_readme_commands_are_those_of_the_program():
    usage = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
    commands = set(re.findall(r"^  ([a-z]+) ", usage, re.MULTILINE)) - {"scree"}
    table = set(re.findall(r"^\| `scree ([a-z]+)", (ROOT / "README.md").read_text(), re.MULTILINE))
    assert table == commands


def test_readme_shell_lines_name_what_exists():
    targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    for block in blocks(ROOT / "README.md", "sh"):
        for line in block.splitlines():
            words = line.split("#")[0].split()
            if words and words[0] == "make":
                assert words[1] in targets
            for word in words:
                if word.startswith("tools/"):
                    assert (ROOT / word).exists(), f"the README runs {word}, which is not there"
