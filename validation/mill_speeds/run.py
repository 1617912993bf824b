"""Power of a mill over its speed, with and without lifters. Makes README.md and its pictures.

Usage: python run.py [--keep]
  --keep   pictures and page again from results.json, without computing anything; the maps are drawn only if their runs are
           still in runs/mill_speeds
QUICK=1 in the environment takes every other speed. A study that was broken off goes on where it stopped.
"""

import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import QUICK, ROOT, Study, in_parallel, plt, table  # noqa: E402
from fields import Fields  # noqa: E402
from run_folder import Run  # noqa: E402

STUDY = Study(__file__)
RADIUS, GRAVITY, START = 0.15, 9.81, 0.2
SPEEDS = [40, 60, 80, 100] if QUICK else [40, 50, 60, 70, 80, 90, 100, 110]
CASES = {"with": "eight lifters of 10 mm x 10 mm", "without": "smooth drum"}
SHOWN = [40, 80, 100]


def rate(percent):
    """[rad/s]"""
    return percent / 100 * math.sqrt(GRAVITY / RADIUS)


def compute():
    cases = [(case, percent) for percent in SPEEDS for case in CASES]
    in_parallel(lambda chosen: run(*chosen), cases)
    return {f"{case}_{percent}": measure(case, percent) for case, percent in cases}


def run(case, percent):
    revolution = 2 * math.pi / rate(percent)
    values = {
        "shapes.bead.size": 0.012, "particles.beads.count": 375, "time.step": 6e-5,
        "time.end": f"{START + 2 * revolution + 1e-3:.6f}", "fields.from": f"{START + revolution:.6f}",
        "walls.drum.motion.angular_velocity": f"{-rate(percent):.6f}",
        "walls.lifters.motion.angular_velocity": f"{-rate(percent):.6f}", "output.frames": 0.5,
    }
    if case == "without":
        values["walls.lifters.removed_at"] = 0
    STUDY.run(ROOT / "scenes" / "tumbling_mill.yaml", f"{case}_{percent}", [f"{key}={value}" for key, value in values.items()])


def folder_of(case, percent):
    return STUDY.runs / f"{case}_{percent}" / "only"


def run_of(case, percent):
    return Run(folder_of(case, percent))


def measure(case, percent):
    run = run_of(case, percent)
    summary, series = run.summary(), run.series()
    loads = summary["wall_loads"]
    power = sum(wall["power_of_periods"] for wall in loads.values())
    work = sum(series[name] for name in series if name.startswith("work_"))
    edges = START + 2 * math.pi / rate(percent) * (1 + np.arange(9) / 8)
    blocks = np.diff(np.interp(edges, series["time"], work)) / np.diff(edges)
    return {"power": power, "error": float(blocks.std(ddof=1) / math.sqrt(8)), "mass": summary["mass"],
            "particles": summary["particles"], "indentation": summary["counters"]["largest_indentation"],
            "energy_error": summary["energy_error"]}


def bond(share):
    """How Bond's formula for the power of ball mills with lifters depends on the share of the critical speed."""
    return share * (1 - 0.1 / 2 ** (9 - 10 * share))


def draw_power(results):
    figure, axes = plt.subplots(figsize=(7, 4.6), layout="constrained")
    for (case, text), style in zip(CASES.items(), ("C0o-", "C1s-"), strict=True):
        rows = [results[f"{case}_{p}"] for p in SPEEDS]
        axes.errorbar(SPEEDS, [r["power"] for r in rows], [r["error"] for r in rows], fmt=style, capsize=2, label=text)
    fitted = [p for p in SPEEDS if p <= 70]
    shares = np.array([bond(p / 100) for p in fitted])
    powers = np.array([results[f"with_{p}"]["power"] for p in fitted])
    factor = float(shares @ powers / (shares @ shares))
    x = np.linspace(40, 110, 100)
    axes.plot(x, factor * bond(x / 100), "k--", lw=1, label="Bond's speed factor, scaled to 40-70 % with lifters")
    axes.set(xlabel="share of the critical speed [%]", ylabel="power [W]", ylim=(0, None))
    axes.legend(frameon=False)
    STUDY.save(figure, "power.png", dpi=100)


def draw_maps():
    if not all(folder_of(case, percent).exists() for case in CASES for percent in SHOWN):
        print("maps.png stays: its runs are gone")
        return
    figure, axes = plt.subplots(2, len(SHOWN), figsize=(11, 7.4), layout="constrained", sharex=True, sharey=True)
    for row, (case, text) in enumerate(CASES.items()):
        for column, percent in enumerate(SHOWN):
            fields = Fields(run_of(case, percent))
            _, fraction, _ = fields.across(1)
            mesh = axes[row, column].pcolormesh(fields.edges(0) * 1e3, fields.edges(2) * 1e3,
                                                np.where(fraction > 0, fraction, np.nan).T, cmap="viridis", vmin=0, vmax=0.7)
            axes[row, column].add_patch(plt.Circle((0, 0), RADIUS * 1e3, fill=False, linewidth=0.8))
            axes[row, column].set_aspect("equal")
            axes[row, column].set_title(f"{text}, {percent} %", fontsize=10)
    figure.colorbar(mesh, ax=axes, label="solid fraction")
    figure.supxlabel("x [mm]")
    figure.supylabel("z [mm]")
    STUDY.save(figure, "maps.png", dpi=90)


def numbers(results):
    rows = []
    for percent in SPEEDS:
        cells = []
        for case in CASES:
            r = results[f"{case}_{percent}"]
            scaled = r["power"] / (r["mass"] * GRAVITY * RADIUS * rate(percent))
            cells += [f"{r['power']:.3f} ± {r['error']:.3f}", f"{scaled:.3f}"]
        rows.append([percent, *cells])
    return table(["share of the critical speed [%]", "with lifters [W]", "power/(m g R ω)", "smooth [W]", "power/(m g R ω)"], rows)


def change_of_lever(results):
    """Of the smooth drum's power/(m g R omega) from the lowest to the highest speed, with its standard error."""
    first, last = (results[f"without_{p}"] for p in (SPEEDS[0], SPEEDS[-1]))
    ratio = last["power"] / first["power"] * SPEEDS[0] / SPEEDS[-1]
    error = ratio * math.hypot(last["error"] / last["power"], first["error"] / first["power"])
    return f"{100 * (ratio - 1):.0f} ± {100 * error:.0f} %"


def crossing(results):
    """What lifters add to the power at the last speed at which they add some, and at the next one."""
    differences = {}
    for percent in SPEEDS:
        a, b = results[f"with_{percent}"], results[f"without_{percent}"]
        differences[percent] = (a["power"] - b["power"], math.hypot(a["error"], b["error"]))
    last = max((p for p in SPEEDS if differences[p][0] > 0), default=SPEEDS[0])
    return " and ".join(f"{differences[p][0]:+.2f} ± {differences[p][1]:.2f} W at {p} %" for p in SPEEDS[SPEEDS.index(last):][:2])


def make_page(results):
    draw_power(results)
    draw_maps()
    rows = [results[f"{case}_{percent}"] for case in CASES for percent in SPEEDS]
    return {"table": numbers(results), "above": change_of_lever(results), "crossing": crossing(results), "energy_error": f"{max(abs(row['energy_error']) for row in rows):.0e}",
            "indentation": f"{100 * max(row['indentation'] for row in rows) / 0.006:.0f}"}


if __name__ == "__main__":
    STUDY.main(compute, make_page)
