"""A free asymmetric top over a million turns, against Jacobi's closed form: makes README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment takes ten thousand turns.
"""

import json
import math
import sys
from pathlib import Path

from scipy.special import ellipk

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import BUILD, QUICK, Study, build, output_of, plt, table  # noqa: E402

STUDY = Study(__file__)
TURNS = 10_000 if QUICK else 1_000_000
INERTIA, START = (1.0, 2.0, 3.0), (0.05, 1.0, 0.02)  # as in rotation_study.c
STYLE = {"scree": "C0o-", "forward Euler": "C3s-"}


def compute():
    build("rotation_study")
    return {"lines": [json.loads(line) for line in output_of([BUILD / "studies/rotation_study", TURNS]).splitlines()]}


def closed_form():
    """Time between two flips in the same sense: 4 K(m)/rate of the Jacobi functions of a free top."""
    momentum2 = sum((i * w) ** 2 for i, w in zip(INERTIA, START))
    energy2 = sum(i * w**2 for i, w in zip(INERTIA, START))
    a, b, c = INERTIA if momentum2 > energy2 * INERTIA[1] else INERTIA[::-1]
    rate = math.sqrt((c - b) * (momentum2 - energy2 * a) / (a * b * c))
    m = (b - a) * (energy2 * c - momentum2) / ((c - b) * (momentum2 - energy2 * a))
    return 4 * ellipk(m) / rate


def orders(lines, exact):
    """Error of the period over the step; rows of a table."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    rows = []
    for method, style in STYLE.items():
        chosen = [x for x in lines if x["part"] == "period" and x["method"] == method]
        errors = [abs(x["period"] / exact - 1) for x in chosen]
        steps = [x["steps_per_turn"] for x in chosen]
        left.loglog(steps, errors, style, ms=4, label=method)
        right.loglog(steps, [x["energy_error"] for x in chosen], style, ms=4, label=method)
        for k, x in enumerate(chosen):
            order = f"{math.log2(errors[k - 1] / errors[k]):.3f}" if k else ""
            rows.append([method, steps[k], f"{x['period']:.9g}", f"{errors[k]:.2e}", order, f"{x['energy_error']:.2e}"])
    left.set(ylabel="relative error of the flip period")
    right.set(ylabel="largest relative error of the energy, 4 flips")
    for ax in (left, right):
        ax.set(xlabel="steps per turn")
        ax.grid(alpha=0.3, which="both")
        ax.legend()
    STUDY.save(figure, "orders.png")
    return table(["method", "steps per turn", "period [s]", "relative error", "order", "largest error of the energy"], rows)


def long_runs(lines):
    figure, ax = plt.subplots(figsize=(6.5, 4), layout="constrained")
    for method, steps, style in (("scree", 50, "C0-"), ("forward Euler", 50, "C3-"), ("forward Euler", 5000, "C3:")):
        chosen = [x for x in lines if x["part"] == "long" and (x["method"], x["steps_per_turn"]) == (method, steps)]
        ax.loglog([x["turns"] for x in chosen], [x["worst"] for x in chosen], style, label=f"{method}, {steps} steps per turn")
    ax.set(xlabel="turns", ylabel="largest relative error of the energy so far")
    ax.grid(alpha=0.3)
    ax.legend()
    STUDY.save(figure, "long.png")
    ends = {x["method"] + str(x["steps_per_turn"]): x for x in lines if x["part"] == "long"}
    own = ends["scree50"]
    lengths = max(abs(x["length_error"]) for x in lines if x["part"] == "long" and x["method"] == "scree")
    return own, ends["forward Euler50"], ends["forward Euler5000"], lengths


def turns_to_gain(lines, steps_per_turn, share):
    """Turns in which forward Euler gains a share of the energy, as far as they were told."""
    turns = [x["turns"] for x in lines if x["part"] == "long" and x["method"] == "forward Euler"
             and x["steps_per_turn"] == steps_per_turn and x["worst"] > share]
    return f"{turns[0]:.0f}" if turns else "more than the run's"


def make_page(results):
    lines = results["lines"]
    exact = closed_form()
    rows = orders(lines, exact)
    own, coarse, fine, lengths = long_runs(lines)
    return {
        "exact": f"{exact:.10g}", "orders": rows, "turns": f"{own['turns']:.0f}", "worst": f"{own['worst']:.2e}",
        "worst_of_four": f"{next(x['worst'] for x in lines if x['part'] == 'long' and x['turns'] > 100):.2e}",
        "length": f"{lengths:.1e}", "coarse_turns": f"{coarse['turns']:.0f}", "coarse": f"{coarse['worst']:.2f}",
        "coarse_gain": turns_to_gain(lines, 50, 0.95), "fine_gain": turns_to_gain(lines, 5000, 0.95),
        "fine_turns": f"{fine['turns']:.0f}", "fine": f"{fine['worst']:.2f}",
        "same": "not one bit" if all(x["same_momentum"] for x in lines if x["part"] == "long") else "A BIT",
    }


if __name__ == "__main__":
    STUDY.main(compute, make_page)
