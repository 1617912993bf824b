"""Error against processor time of the settings a user can choose, in three scenes: makes README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment takes one start of each scene and fewer settings. A study that was broken off goes on where it stopped.
"""

import math
import re
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
from matplotlib.ticker import FixedLocator, NullFormatter

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import PROGRAM, QUICK, SINGLE_PROGRAM, Study, build, plt, table, write_scene  # noqa: E402
from run_folder import Run  # noqa: E402
from scenes import RIG, collisions, flow, packing  # noqa: E402

STUDY = Study(__file__)
EARLY = 0.25  # time at which positions in the packing are compared [s]
BASE = ("time step", "0.5")
FINEST = {"collisions": 64, "packing": 16, "flow": 4}  # finest step: 1/this of the critical one
if QUICK:
    RIG["count"] = 15
SEEDS = dict.fromkeys(FINEST, 1) if QUICK else {"collisions": 3, "packing": 3, "flow": 2}


def settings(scene):
    """List of (axis, value, texts PATH=VALUE, triangles, program); steps are in shares of the critical step."""
    fractions = [1 / FINEST[scene], 1 / 8, 1 / 4, 1 / 2, 1, 1.5, 2]
    fractions = [f for f in sorted(set(fractions)) if f >= fractions[0] and not (QUICK and f in (1 / 8, 1.5))]
    rows = [("time step", f"{f:g}", f, [], 40, PROGRAM) for f in fractions]
    rows += [("single precision", f"{f:g}", f, [], 40, SINGLE_PROGRAM) for f in fractions
             if f == 1 / 2 or (f == 1 / 8 and scene != "flow")]
    triangles = [10, 150] if scene == "flow" or QUICK else [10, 20, 100, 300, 1000]
    rows += [("triangles", str(n), 0.5, [], n, PROGRAM) for n in triangles]
    skins = [0.3] if QUICK else [0.03, 0.3] if scene == "flow" else [0, 0.03, 0.3, 1]
    rows += [("skin", f"{skin:g}", 0.5, [f"solver.skin={skin}"], 40, PROGRAM) for skin in skins]
    return [*rows, ("overlap scheme", "hierarchy", 0.5, ["solver.overlap_scheme=hierarchy"], 40, PROGRAM)]


MAKERS = {"collisions": collisions, "packing": packing, "flow": flow}


def made(scene, seed, triangles):
    """Path of the scene, written once."""
    path = STUDY.runs / scene / f"{seed}_{triangles}.yaml"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_scene(path, MAKERS[scene](seed, triangles, (PROGRAM, path.parent)))
    return path


def critical_step(path):
    """The one that scree check tells of a scene."""
    done = subprocess.run([PROGRAM, "check", path], check=True, capture_output=True, text=True)
    return float(re.search(r"of the critical step of (\S+) s", done.stdout)[1])


def run_one(scene, seed, setting, critical, end=None):
    """Folder of the run of a scene with a setting; up to a time if it is given."""
    axis, value, fraction, texts, triangles, program = setting
    path = made(scene, seed, triangles)
    name = f"{axis}_{value}_{seed}".replace(" ", "_") + (f"_to_{end}" if end else "")
    texts = [*texts, f"time.step={fraction * critical:.6g}", *([f"time.end={end}"] if end else [])]
    return STUDY.run(path, f"{scene}/{name}", texts, program)


def state(member):
    with h5py.File(member.folder / "checkpoint.h5") as file:
        return {name: file["particles"][name][:].astype(float) for name in ("position", "velocity")}


def measure(scene, member, early):
    """Numbers of a run: `fields` are compared body by body, the others as means."""
    summary = member.summary()
    row = {"seconds": summary["processor_seconds"], "balance": abs(summary["energy_error"]), "hash": summary["state_hash"]}
    if scene == "collisions":
        return row | {"field": (state(member)["velocity"] / 2).tolist()}
    if scene == "packing":
        return row | {"field": (state(early)["position"] / 0.05).tolist(),
                      "rest": summary["energies"]["kinetic"], "height": summary["energies"]["potential"] / (summary["mass"] * 9.81),
                      "coordination": summary["counters"]["coordination_number"]}
    series = Run(member.folder).series()
    during = series["time"] >= RIG["opening"]
    moving = (series["kinetic"] + series["rotational"])[during]
    return row | {"flow": float(np.trapezoid(moving, series["time"][during]) / np.ptp(series["time"][during])),
                  "left": summary["energies"]["potential"] / (summary["mass"] * 9.81)}


def is_wanted(scene, setting, seed):
    """In the flow the settings that change no result run once, for their time."""
    return scene != "flow" or seed == 1 or setting[0] not in ("skin", "overlap scheme")


def compute():
    build("scree_program", "scree_single_program")
    results = {}
    for scene in MAKERS:
        critical = critical_step(made(scene, 1, 40))
        results[scene] = {"critical": critical, "runs": []}
        for seed in range(1, SEEDS[scene] + 1):
            print(f"== {scene}, start {seed}", flush=True)
            for setting in settings(scene):
                if is_wanted(scene, setting, seed):
                    early = run_one(scene, seed, setting, critical, EARLY) if scene == "packing" else None
                    member = run_one(scene, seed, setting, critical)
                    results[scene]["runs"].append({"axis": setting[0], "value": setting[1], "seed": seed}
                                                  | measure(scene, member, early))
    return summarise(results)


def distances(first, second):
    """Of the bodies [1]: their mean, and what nine tenths are below."""
    apart = np.linalg.norm(np.subtract(first, second), axis=1)
    return float(apart.mean()), float(np.quantile(apart, 0.9))


def summarise(results):
    """Distances from the finest run instead of bodies: what the page needs."""
    for scene in MAKERS:
        runs = results[scene]["runs"]
        runs += [run | {"axis": "triangles", "value": "40"} for run in runs if (run["axis"], run["value"]) == BASE]
        runs.sort(key=lambda run: (list(STYLES).index(run["axis"]), run["axis"] != "overlap scheme" and float(run["value"])))
        by_name = {(run["axis"], run["value"], run["seed"]): run for run in runs}
        steps = [run["value"] for run in runs if run["axis"] == "time step"]
        meshes = [run["value"] for run in runs if run["axis"] == "triangles"]
        for run in runs:
            base = by_name[*BASE, run["seed"]]
            finest = by_name["time step", steps[0], run["seed"]]
            if run["axis"] == "triangles":
                finest = by_name["triangles", meshes[-1], run["seed"]]
            run["ratio"] = run["seconds"] / base["seconds"]
            run["as_base"] = run["hash"] == base["hash"]
            if "field" in run:
                run["error"], run["worst"] = distances(run["field"], finest["field"])
                run["from_base"] = distances(run["field"], base["field"])[0]
        for run in runs:
            run.pop("field", None)
    return results


STYLES = {"time step": "C0o", "single precision": "C3^", "triangles": "C2s", "skin": "C4D", "overlap scheme": "C1P"}
"""Colour and marker of what is changed."""
MEASURES = {  # panel: (scene, column, is a mean over starts, label)
    "collisions": ("collisions", "error", False, "velocity after the impact, over 2 m/s"),
    "packing_early": ("packing", "error", False, f"positions after {EARLY} s, over the size"),
    "packing": ("packing", "height", True, "mean height at rest"),
    "packing_contacts": ("packing", "coordination", True, "coordination number at rest"),
    "flow": ("flow", "flow", True, "flow energy"),
}


def points(results, panel):
    """Per setting in order: error and its standard error over the starts, time over that of the default as median and range,
    and whether all bits are those of the default."""
    scene, column, is_mean, _ = MEASURES[panel]
    runs = results[scene]["runs"]
    rows, names = [], list(dict.fromkeys((run["axis"], run["value"]) for run in runs))
    by_name = {name: {run["seed"]: run for run in runs if (run["axis"], run["value"]) == name} for name in names}
    for name, chosen in by_name.items():
        errors = [run[column] for run in chosen.values()]
        if is_mean:
            finest = by_name[names_of(names, "triangles")[-1] if name[0] == "triangles" else names_of(names, "time step")[0]]
            errors = [run[column] / finest[seed][column] - 1 for seed, run in chosen.items()]
        error, uncertainty = float(np.mean(errors)), standard_error(errors)
        as_base = all(run["as_base"] for run in chosen.values())
        if as_base and is_mean and name[0] == "skin":  # which may have run for fewer starts
            error, uncertainty = next((row["error"], row["uncertainty"]) for row in rows if (row["axis"], row["value"]) == BASE)
        times = [run["ratio"] for run in chosen.values()]
        rows.append({"axis": name[0], "value": name[1], "error": error, "uncertainty": uncertainty, "runs": len(errors),
                     "time": float(np.median(times)), "times": (min(times), max(times)), "as_base": as_base})
    return rows


def standard_error(values):
    """Of their mean; unknown (nan) from one."""
    return float(np.std(values, ddof=1) / math.sqrt(len(values))) if len(values) > 1 else math.nan


def names_of(names, axis):
    return [name for name in names if name[0] == axis]


def noise(results, panel):
    """Standard error of the mean over starts of a relative difference from the finest step, the same for all steps."""
    rows = [row for row in points(results, panel) if row["axis"] == "time step" and row["error"] != 0]
    return math.sqrt(np.mean([row["uncertainty"] ** 2 for row in rows]))


def draw(ax, results, panel):
    """Distances on a logarithmic axis, those of the finest runs, zero, hollow at its left edge; differences of means, which may
    be noise, with their sign."""
    is_mean = MEASURES[panel][2]
    rows = points(results, panel)
    edge = min(row["error"] for row in rows if row["error"] > 0) / 3
    for axis, style in STYLES.items():
        chosen = [row for row in rows if row["axis"] == axis]
        finest = [] if is_mean else [row | {"error": edge, "value": f"{row['value']} (finest, 0)"} for row in chosen if row["error"] == 0]
        shown = [row for row in chosen if is_mean or row["error"] > 0]
        is_line = not is_mean and axis in ("time step", "triangles")
        ax.errorbar([row["error"] for row in shown], [row["time"] for row in shown],
                    xerr=np.nan_to_num([row["uncertainty"] for row in shown]), fmt=style + "-" * is_line, ms=5, lw=1,
                    elinewidth=0.8, label=axis)
        ax.plot([row["error"] for row in finest], [row["time"] for row in finest], style, ms=6, mfc="none")
        for row in shown + finest:
            ax.annotate(row["value"], (row["error"], row["time"]), xytext=(-5, -3) if axis == "skin" else (5, 3),
                        ha="right" if axis == "skin" else "left", textcoords="offset points", fontsize=7)
    if is_mean and not math.isnan(noise(results, panel)):
        ax.axvspan(-noise(results, panel), noise(results, panel), color="0.9", zorder=0)
    ax.set(xscale="linear" if is_mean else "log", yscale="log", xlabel=f"error of {MEASURES[panel][3]}")
    ax.yaxis.set_major_locator(FixedLocator([0.25, 0.5, 1, 2, 4, 8, 16]))
    ax.yaxis.set_major_formatter("{x:g}")
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.grid(alpha=0.3)


def plot(results, name, panels):
    figure, axes = plt.subplots(1, len(panels), figsize=(6.2 * len(panels) + 0.8, 4.8), layout="constrained", squeeze=False)
    for ax, panel in zip(axes[0], panels, strict=True):
        draw(ax, results, panel)
    axes[0][0].set_ylabel("processor time over that of the default")
    axes[0][-1].legend(fontsize=8)
    STUDY.save(figure, name)


def errors_table(results, panels):
    """One row per setting; of several panels of a scene, the errors beside each other."""
    columns = [points(results, panel) for panel in panels]
    head = ["setting", "value", *(f"error of {MEASURES[panel][3]}" for panel in panels), "time", "of the starts", "bits of the default"]
    return table(head, [[rows[0]["axis"], rows[0]["value"],
                         *(number(row, MEASURES[panel][2]) for row, panel in zip(rows, panels, strict=True)),
                         f"{rows[0]['time']:.2f}", "{:.2f} to {:.2f}".format(*rows[0]["times"]) if rows[0]["runs"] > 1 else "",
                         "yes" if rows[0]["as_base"] else ""] for rows in zip(*columns, strict=True)])


def number(row, is_mean):
    if row["error"] == 0:
        return "0 (finest)"
    digits = 3 if is_mean else max(0, 1 - math.floor(math.log10(row["error"])))
    value = f"{row['error']:{'+' if is_mean else ''}.{digits}f}"
    return value + (" (one start)" if math.isnan(row["uncertainty"]) else f" ± {row['uncertainty']:.{digits}f}")


def percent(value):
    return "unknown from one start" if math.isnan(value) else f"{100 * value:.0f} %"


def make_page(results):
    plot(results, "collisions.png", ["collisions"])
    plot(results, "packing.png", ["packing_early", "packing"])
    plot(results, "flow.png", ["flow"])
    seconds = sum(run["seconds"] for scene in MAKERS for run in results[scene]["runs"]
                  if (run["axis"], run["value"]) != ("triangles", "40"))
    texts = {"collisions": errors_table(results, ["collisions"]), "packing": errors_table(results, ["packing_early", "packing", "packing_contacts"]),
             "flow": errors_table(results, ["flow"]), "minutes": f"{seconds / 60:.0f}",
             "early": f"{EARLY:g}", "remark": results.get("remark", "")} | {
        f"noise_{panel}": percent(noise(results, panel)) for panel in ("packing", "packing_contacts", "flow")}
    texts |= {f"seeds_{scene}": str(max(run["seed"] for run in results[scene]["runs"])) for scene in MAKERS}
    texts |= {f"step_{scene}": f"{results[scene]['critical']:.2e}" for scene in MAKERS}
    return texts


if __name__ == "__main__":
    STUDY.main(compute, make_page)
