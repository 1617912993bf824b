"""What the scripts of all studies share: folders, programs, quick versions, results, plots and pages.

A study is a folder with run.py and page.md, the page with {{names}} where computed texts go. Its README.md, plots and
results.json lie beside them. With QUICK=1 in the environment they go into runs/quick/NAME instead, so that the page of the whole
study stays. What the programs write is kept in runs/NAME, or runs/quick/NAME/runs: a study that was broken off goes on there.
"""

import json
import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from ensemble import Ensemble, Refused  # noqa: E402

BUILD = Path(os.environ.get("SCREE_BUILD_DIR", ROOT / "build" / "release")).resolve()
"""With SCREE_BUILD_DIR in the environment the programs are taken as they are there; nothing is built."""
PROGRAM, SINGLE_PROGRAM = BUILD / "scree", BUILD / "scree_single"
QUICK = os.environ.get("QUICK") == "1"
CORES = len(os.sched_getaffinity(0))
ENGINE = ("src", "include", "cmake", "CMakeLists.txt", "CMakePresets.json")  # what the numbers of a study depend on


def git(*arguments):
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else ""


def engine_commit():
    """The last commit that changed the engine."""
    commit = git("log", "-1", "--format=%h", "--", *ENGINE) or "unknown"
    return commit + " with changes" if git("status", "--porcelain", "--", *ENGINE) else commit


def output_of(command, **options):
    """Runs a program on one thread, tells its command; its standard output."""
    print("+", *command, flush=True)
    options = {"env": dict(os.environ, OMP_NUM_THREADS="1")} | options
    return subprocess.run([str(part) for part in command], check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def build(*targets):
    if "SCREE_BUILD_DIR" not in os.environ:
        output_of(["cmake", "--preset", "release", "--log-level=WARNING"], cwd=ROOT)
        output_of(["cmake", "--build", BUILD, "--target", *targets], cwd=ROOT)


def in_parallel(function, jobs):
    """function(job) of all jobs on all cores; what has not begun when one fails, or at Ctrl-C, does not begin."""
    pool = ThreadPoolExecutor(CORES)
    try:
        for done in as_completed([pool.submit(function, job) for job in jobs]):
            done.result()
    finally:
        pool.shutdown(cancel_futures=True)


def write_scene(path, content):
    """A scene from dictionaries and lists: YAML reads JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content, indent=1) + "\n")
    return path


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def readable(results):
    """JSON with a line for each part of a result, and for each row of a list."""
    parts = []
    for name, value in results.items():
        is_list = isinstance(value, list) and len(value) > 0
        text = "[\n" + ",\n".join(json.dumps(row) for row in value) + "\n]" if is_list else json.dumps(value)
        parts.append(f"{json.dumps(name)}: {text}")
    return "{\n" + ",\n".join(parts) + "\n}\n"


class Study:
    """The study of one run.py: folder (script and page.md), output (page, plots, results), runs."""

    def __init__(self, script):
        self.folder = Path(script).resolve().parent
        name = self.folder.name
        self.output = ROOT / "runs" / "quick" / name if QUICK else self.folder
        self.runs = self.output / "runs" if QUICK else ROOT / "runs" / name
        self.results = self.output / "results.json"
        self.ensembles, self.kept_files, self.is_stopped = [], [], False

    def ensemble(self, scene, name, varied=(), settings=(), program=PROGRAM):
        """The runs of a scene in a folder of this study, one thread each; see tools/ensemble.py."""
        self.ensembles.append(Ensemble(scene, self.runs / name, list(varied), settings, program))
        return self.ensembles[-1]

    def run(self, scene, name, settings=(), program=PROGRAM):
        """Runs a scene if that is not done; the member of an ensemble of one."""
        if self.is_stopped:
            raise SystemExit("stopped")
        print(f"+ scree run {name}", flush=True)
        ensemble = self.ensemble(scene, name, settings=settings, program=program)
        self.expect(ensemble.run(jobs=1))
        return ensemble.members[0]

    def kept(self, name, make):
        """make(), or what it gave before the study was broken off: for what is no run of a scene."""
        path = self.runs / f"{name}.json"
        self.kept_files.append(path)
        if not path.exists():
            part = path.with_suffix(".part")
            part.write_text(json.dumps(make()))
            part.rename(path)
        return json.loads(path.read_text())

    @staticmethod
    def expect(failed):
        if failed:
            raise SystemExit(f"{failed[0].folder} did not finish; see messages.txt there")

    def save(self, figure, name, dpi=130):
        figure.savefig(self.output / name, dpi=dpi)
        plt.close(figure)

    def main(self, compute, make_page, finished=None):
        """What run.py does with its arguments.

        compute(): the results, anything that JSON holds; make_page(results): the plots, and the texts of the page by name;
        finished(): results from the runs that are finished.
        """
        arguments = sys.argv[1:]
        makers = {(): compute} | ({("--finished",): finished} if finished else {})
        if tuple(arguments) not in (*makers, ("--keep",)):
            raise SystemExit(sys.modules["__main__"].__doc__)
        if arguments != ["--keep"]:
            self.begin()
            signal.signal(signal.SIGTERM, self.stop)
            try:
                results = {"commit": engine_commit()} | makers[tuple(arguments)]()
            except Refused as refused:
                raise SystemExit(f"{refused}; for a study: delete {self.runs}") from None
            except KeyboardInterrupt:
                raise SystemExit("stopped; the same command goes on") from None
            self.results.write_text(readable(results))
            for path in self.kept_files:
                path.unlink()
        results = json.loads(self.results.read_text())
        self.write_page({"commit": results["commit"]} | make_page(results))

    def begin(self):
        """Refuses to mix runs of different engines."""
        self.output.mkdir(parents=True, exist_ok=True)
        self.runs.mkdir(parents=True, exist_ok=True)
        path, commit = self.runs / "engine.txt", engine_commit()
        if not path.exists() and not any(self.runs.iterdir()):
            path.write_text(commit + "\n")
        before = path.read_text().strip() if path.exists() else "unknown"
        if before != commit:
            raise SystemExit(f"{self.runs} holds runs of another engine (commit {before}, now {commit}): delete that folder to "
                             "begin anew")

    def stop(self, *_):
        """For SIGTERM, which the runs do not get by themselves."""
        self.is_stopped = True
        for ensemble in self.ensembles:
            ensemble.is_stopped = True
            for process in list(ensemble.running):
                process.terminate()
        raise KeyboardInterrupt

    def write_page(self, texts):
        page = (self.folder / "page.md").read_text()
        for name, text in texts.items():
            page = page.replace("{{" + name + "}}", text)
        if "{{" in page:
            raise SystemExit(f"page.md has a text that run.py does not make: {page[page.index('{{'):][:40]}")
        if QUICK:
            title, _, rest = page.partition("\n")
            page = f"{title}\n\n*Made with QUICK=1, by fewer or smaller runs. Sentences are those of the whole study.*\n{rest}"
        (self.output / "README.md").write_text(page)
