#!/usr/bin/env python3
"""Runs a scene for every combination of some of its values, in parallel, and makes one table of all the summaries.

  tools/ensemble.py SCENE -o FOLDER --vary PATH=VALUES [--vary ...] [--set PATH=VALUE ...]

VALUES are separated by commas, whole numbers also as FIRST..LAST; PATH is that of `scree run --set`. Paths joined by + take
the same value. Each combination is a run in FOLDER/NAME; FOLDER/ensemble.csv has a row for each, with the values and all
numbers of its summary. The same command again goes on where it stopped: finished runs are kept, broken ones go on from
their checkpoints. A run whose scene or values are others than before is refused without --replace.

Exit code: 0 all finished; 1 some failed, which are named; 2 the command line was refused; 130 stopped by Ctrl-C.
"""
import argparse
import csv
import fcntl
import hashlib
import itertools
import json
import os
import re
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


class Refused(Exception):
    """What is wrong with the command line, and what to do."""


def parse_values(text):
    """`0.1,0.2` or `1..5` to a list of texts."""
    values = []
    for part in text.split(","):
        whole = re.fullmatch(r"(-?\d+)\.\.(-?\d+)", part.strip())
        if whole:
            first, last = int(whole[1]), int(whole[2])
            if last < first:
                raise Refused(f"range {part} is empty; write the smaller number first")
            values += [str(k) for k in range(first, last + 1)]
        elif part.strip():
            values.append(part.strip())
    return values


def parse_vary(text):
    """`a.b+c.d=1,2` to (["a.b", "c.d"], ["1", "2"])."""
    paths, equals, values = text.partition("=")
    paths = [path.strip() for path in paths.split("+")]
    if not equals or not all(paths) or not parse_values(values):
        raise Refused(f"--vary {text}: write PATH=VALUE,VALUE,... as in --vary particles.fill.seed=1..5")
    return paths, parse_values(values)


class Member:
    """One combination: its values by path and its folder."""

    def __init__(self, folder, values, labels):
        self.values = values
        name = ",".join(f"{label}={values[path]}" for path, label in labels)
        self.folder = folder / (re.sub(r"[^\w=,.+-]", "_", name) or "only")

    def summary(self):
        path = self.folder / "summary.json"
        try:
            return json.loads(path.read_text())
        except (OSError, json.JSONDecodeError):
            return {}

    def is_finished(self):
        return self.summary().get("outcome") == "finished"


def short_labels(varied):
    """The last word of each path, or all of it where two paths end alike."""
    last = [paths[0].split(".")[-1] for paths, _ in varied]
    return [(paths[0], name if last.count(name) == 1 else paths[0]) for (paths, _), name in zip(varied, last)]


class Ensemble:
    """All members of a scene and what they are made from.

    varied: list of (paths, values); settings: texts PATH=VALUE for all members.
    """

    def __init__(self, scene, folder, varied, settings=(), program=ROOT / "build" / "release" / "scree", threads=1):
        self.scene, self.folder, self.program, self.threads = Path(scene), Path(folder), Path(program), threads
        self.settings = list(settings)
        if not self.scene.is_file():
            raise Refused(f"there is no scene {scene}")
        if not self.program.is_file():
            raise Refused(f"there is no program {program}: build it with make build, or name another with --program")
        self.varied, self.labels = varied, short_labels(varied)
        self.members = []
        for combination in itertools.product(*(values for _, values in varied)):
            values = {path: value for (paths, _), value in zip(varied, combination) for path in paths}
            self.members.append(Member(self.folder, values, self.labels))
        twice = [m.folder.name for k, m in enumerate(self.members) if m.folder in [o.folder for o in self.members[:k]]]
        if twice:
            raise Refused(f"the combination {twice[0]} is asked for twice")
        self.lock, self.running, self.is_stopped = threading.Lock(), set(), False

    def origin(self, member):
        """What a run depends on, to be kept beside it."""
        text = hashlib.sha256(self.scene.read_bytes()).hexdigest()
        return {"scene": self.scene.name, "scene_sha256": text, "settings": self.settings, "values": member.values}

    def check_origins(self):
        others = []
        for member in self.members:
            path = member.folder / "member.json"
            if path.exists() and json.loads(path.read_text()) != self.origin(member):
                others.append(member.folder)
        if others:
            raise Refused(f"{len(others)} of the runs, like {others[0]}, were made from another scene or other values; take "
                          "another folder, or --replace to do them again")

    def command(self, member, replaces):
        pairs = [f"{path}={value}" for path, value in member.values.items()]
        command = [str(self.program), "run", str(self.scene), "-o", str(member.folder), "--quiet", "--threads", str(self.threads)]
        for pair in (*self.settings, *pairs):
            command += ["--set", pair]
        has_checkpoint = (member.folder / "checkpoint.h5").exists()
        return command + (["--restart"] if has_checkpoint and not replaces else ["--replace"])

    def run_member(self, member, replaces):
        """True if it is finished."""
        if self.is_stopped:
            return False
        member.folder.mkdir(parents=True, exist_ok=True)
        with open(member.folder / "in_use", "w") as in_use:
            # the run holds it too: where this program was killed, the next one waits for what goes on
            fcntl.flock(in_use, fcntl.LOCK_EX)
            if member.is_finished() and not replaces:
                return True
            return self.run_alone(member, replaces, in_use)

    def run_alone(self, member, replaces, in_use):
        command = self.command(member, replaces)
        (member.folder / "member.json").write_text(json.dumps(self.origin(member), indent=1))
        with open(member.folder / "messages.txt", "w") as messages:
            process = subprocess.Popen(command, stdout=messages, stderr=messages, pass_fds=[in_use.fileno()])
            with self.lock:
                self.running.add(process)
            code = process.wait()
            with self.lock:
                self.running.discard(process)
        print(f"{member.folder.name}: {'finished' if code == 0 else f'exit code {code}'}", flush=True)
        return code == 0

    def run(self, jobs=None, replaces=False):
        """Runs what is not finished; returns the members that failed."""
        if not replaces:
            self.check_origins()
        todo = [m for m in self.members if replaces or not m.is_finished()]
        pool = ThreadPoolExecutor(jobs or max(1, len(os.sched_getaffinity(0)) // self.threads))
        try:
            done = list(pool.map(lambda member: self.run_member(member, replaces), todo))
        except KeyboardInterrupt:
            # the runs got the signal too and end with a checkpoint
            self.is_stopped = True
            pool.shutdown(wait=True, cancel_futures=True)
            raise
        return [member for member, is_done in zip(todo, done) if not is_done]

    def stop(self, *_):
        """For SIGTERM, which the runs do not get by themselves: each ends with a checkpoint."""
        for process in list(self.running):
            process.terminate()
        raise KeyboardInterrupt

    def table(self):
        """Rows of all finished members: values by label, then the numbers of the summary."""
        rows = []
        for member in self.members:
            if member.is_finished():
                row = {label: member.values[path] for path, label in self.labels}
                rows.append(row | flat_numbers(member.summary()) | {"folder": member.folder.name})
        return rows

    def write_table(self):
        rows = self.table()
        columns = list(dict.fromkeys(column for row in rows for column in row))
        path = self.folder / "ensemble.csv"
        temporary = path.with_suffix(".csv.part")
        with open(temporary, "w", newline="") as file:
            writer = csv.DictWriter(file, columns)
            writer.writeheader()
            writer.writerows(rows)
        temporary.rename(path)
        return path


def flat_numbers(summary, prefix=""):
    """Numbers and short texts of a summary by names like energies.kinetic; lists are left out."""
    flat = {}
    for name, value in summary.items():
        if isinstance(value, dict):
            flat |= flat_numbers(value, f"{prefix}{name}.")
        elif not isinstance(value, list):
            flat[prefix + name] = value
    return flat


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("-o", dest="folder", required=True, help="folder of all runs and the table")
    parser.add_argument("--vary", action="append", default=[], metavar="PATH=VALUES", help="can be repeated: all combinations")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="for all runs; can be repeated")
    parser.add_argument("--jobs", type=int, help="runs at a time; default: number of cores over --threads")
    parser.add_argument("--threads", type=int, default=1, help="threads of a run; results are the same for any")
    parser.add_argument("--program", default=ROOT / "build" / "release" / "scree", help="default: build/release/scree")
    parser.add_argument("--replace", action="store_true", help="does finished runs again")
    arguments = parser.parse_args()
    if arguments.threads < 1 or (arguments.jobs is not None and arguments.jobs < 1):
        parser.error("--jobs and --threads are at least 1")
    try:
        varied = [parse_vary(text) for text in arguments.vary]
        ensemble = Ensemble(arguments.scene, arguments.folder, varied, arguments.set, arguments.program, arguments.threads)
        signal.signal(signal.SIGTERM, ensemble.stop)
        failed = ensemble.run(arguments.jobs, arguments.replace)
    except Refused as refused:
        parser.error(str(refused))
    except KeyboardInterrupt:
        print("stopped; the same command goes on", file=sys.stderr)
        sys.exit(130)
    print(ensemble.write_table())
    for member in failed:
        messages = (member.folder / "messages.txt").read_text().strip().splitlines()
        print(f"{member.folder} did not finish: {messages[0] if messages else 'no message'}", file=sys.stderr)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
