#!/usr/bin/env python3
"""Writes baseline.json beside it: what `scree bench NAME --baseline benchmarks/baseline.json` compares with.

Usage: make_baseline.py [PROGRAM]     default build/release/scree; run it on a machine that is idle
"""

import json
import pathlib
import subprocess
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
PROGRAM = sys.argv[1] if len(sys.argv) > 1 else FOLDER.parent / "build/release/scree"
OPTIONS = {
    "overlap": [],
    "broad-phase": ["--particles", "100000"],
    "packing": ["--particles", "4000"],
    "spheres": [],
    # the rocks fall for some 8000 steps; without contacts the time would say nothing
    "rig": ["--particles", "50", "--steps", "14000", "--repetitions", "3"],
    "scaling": ["--particles", "10000", "--threads", "2"],
}


def measure(name, options):
    command = [PROGRAM, "bench", name, *options, "--json", "-"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True, cwd=FOLDER.parent).stdout)


results = {name: measure(name, options) for name, options in OPTIONS.items()}
for case in results["rig"]["cases"]:
    assert case["mean_contacts"] > 0, f"rig: nothing touches in {case['steps']} steps; take more"
(FOLDER / "baseline.json").write_text(json.dumps(results, indent=1) + "\n")
