"""A small calibration rig over triangles, friction and the tangential spring: makes README.md and its plots.

Usage: python run.py [--keep | --finished]
  --keep       plots and page again from results.json, without computing anything
  --finished   the same from the runs that are finished, of a study that was broken off
QUICK=1 in the environment takes 25 rocks, one seed and three cases of each kind. A study that was broken off goes on where it stopped.
"""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import PROGRAM, QUICK, Study, in_parallel, plt, table, write_scene  # noqa: E402
from rig import rig, rock_scale  # noqa: E402
from run_folder import Run  # noqa: E402

STUDY = Study(__file__)
PROPORTIONS = {"count": 90, "scale": 0.58, "depth": 0.044, "opening": 0.3, "end": 1.1, "step": "auto"}
TRIANGLES = (10, 20, 40, 60, 100, 150)
FRICTION = (0.1, 0.2, 0.6, 0.8)
SEEDS, FEW_SEEDS, SPRING_SEEDS = 11, 3, 2
if QUICK:
    PROPORTIONS |= {"count": 25, "end": 0.9}
    TRIANGLES, FRICTION = (10, 40, 150), (0.1, 0.8)
    SEEDS = FEW_SEEDS = SPRING_SEEDS = 1
BAND = (33, 42)  # of the experiments of the source [degrees]
COLUMNS = (("angle", "angle of repose [degrees]", 1), ("flow", "flow energy [mJ]", 1e3))
FLOW = 0.6  # time after the opening of the doors over which the flow energy is taken [s]
LONG = PROPORTIONS["end"] + 0.5  # end of the runs that are shown over time, and of those that rest late [s]
CREEP = 0.35  # time before it over which their creep is measured [s]


def cases():
    """Name: (what differs from 40 triangles and the friction of the source, number of seeds)."""
    all_cases = {f"triangles_{n}": ({"triangles": n}, SEEDS) for n in TRIANGLES}
    all_cases |= {name: (changes | {"end": LONG}, SPRING_SEEDS) for name, changes in (("no_spring", {"spring": 0}), ("spring", {}))}
    all_cases |= {f"friction_{mu:g}": ({"friction": mu}, FEW_SEEDS) for mu in FRICTION}
    all_cases["smooth_sides"] = ({"side_friction": 0}, FEW_SEEDS)
    all_cases["narrow"] = ({"depth": 0.6 * PROPORTIONS["depth"], "end": LONG}, FEW_SEEDS)
    all_cases["more_rocks"] = ({"count": round(1.6 * PROPORTIONS["count"]), "end": LONG}, FEW_SEEDS)
    all_cases["half_step"] = ({"step_fraction": 0.5}, FEW_SEEDS)
    return all_cases


def compute():
    # seed by seed, so that a study that is broken off has a bit of everything; what has few seeds comes second
    jobs = sorted(((seed, name) for name, (_, seeds) in cases().items() for seed in range(1, seeds + 1)),
                  key=lambda job: job[0] + 2 * (not job[1].startswith("triangles")))

    def run(job):
        seed, name = job
        STUDY.run(write_scene(scene_path(name, seed), scene(name, seed)), f"{name}/{seed}")

    in_parallel(run, jobs)
    return collect()


def scene(name, seed):
    """The seed is that of the rock as well as of sizes, places and orientations."""
    changes, _ = cases()[name]
    of_rig = {key: value for key, value in changes.items() if key in (*PROPORTIONS, "step_fraction")}
    changes = {key: value for key, value in changes.items() if key not in of_rig}
    made = rig(rock_scale(PROGRAM, changes.get("triangles", 40), seed), PROPORTIONS | of_rig, seed=seed, **changes)
    made["particles"][0]["seed"] = seed
    return made


def scene_path(name, seed):
    return STUDY.runs / name / f"{seed}.yaml"


def member_of(name, seed):
    """None if it is not finished."""
    if not scene_path(name, seed).exists():
        return None
    (member,) = STUDY.ensemble(scene_path(name, seed), f"{name}/{seed}").members
    return member if member.is_finished() else None


def measure(name, seed, member):
    """Numbers of a run. Flow energy: mean of the kinetic energy after the opening of the doors."""
    series, summary = Run(member.folder).series(), member.summary()
    time, moving = series["time"], series["kinetic"] + series["rotational"]
    during = (time >= PROPORTIONS["opening"]) & (time <= PROPORTIONS["opening"] + FLOW)
    counters = summary["counters"]
    weight = summary["mass"] * 9.81
    row = {
        "case": name, "seed": seed, "angle": summary["repose_angle_degrees"], "residual": summary["repose_fit_residual"],
        "flow": float(np.trapezoid(moving[during], time[during]) / np.ptp(time[during])),
        "peak": float(moving[during].max()), "rest": float(moving[-1]), "height": summary["energies"]["potential"] / weight,
        "coordination": counters["coordination_number"], "balance": abs(summary["energy_error"]),
        "measured_step": counters["smallest_critical_step"], "deepest": counters["largest_indentation"],
        "mass": summary["mass"],
        # the summary knows the time of the last session only
        "seconds": summary["processor_seconds"] if summary["steps_run"] == summary["num_steps"] else None,
    }
    if name in ("no_spring", "spring"):
        row |= {"time": time.tolist(), "moving": moving.tolist(), "heights": (series["potential"] / weight).tolist()}
        row |= angles(Run(member.folder))
    return row


def angles(run):
    """Angle of repose over time, from the frames after the flow, as scree measures it at the end."""
    frames, width = run.surfaces(), PROPORTIONS["scale"] * 0.2 / 20
    kept = [k for k, time in enumerate(frames.times) if time >= PROPORTIONS["end"] - 0.26]
    found = []
    for k in kept:
        points = frames.read(k)["points"].astype(float)
        heights = np.zeros(20)
        bins = np.floor(points[:, 0] / width).astype(int)
        inside = (bins >= 0) & (bins < 20) & (points[:, 2] < PROPORTIONS["scale"] * 0.09)
        np.maximum.at(heights, bins[inside], points[inside, 2])
        found.append(fitted_angle((np.arange(20) + 0.5) * width, heights))
    return {"angle_times": frames.times[kept].tolist(), "angles": found}


def fitted_angle(x, heights):
    """Steepest slope of the sigmoid of least squares [degrees]."""
    start = (heights.max(), 50.0, x[np.argmin(np.abs(heights - heights.max() / 2))])
    fit = least_squares(lambda p: p[0] / (1 + np.exp(np.clip(p[1] * (x - p[2]), -700, 700))) - heights, start,
                        x_scale=(0.01, 10, 0.01))
    return math.degrees(math.atan(abs(fit.x[0] * fit.x[1]) / 4))


def collect():
    planned = [(name, seed) for name, (_, seeds) in cases().items() for seed in range(1, seeds + 1)]
    members = [(name, seed, member_of(name, seed)) for name, seed in planned]
    rows = [measure(*chosen) for chosen in members if chosen[2]]
    return {"proportions": PROPORTIONS, "planned": len(planned), "rows": rows}


def of_case(results, name, column):
    return np.array([row[column] for row in rows_of(results, name)], dtype=float)


def scatter(ax, results, named, column, unit, colour="C0"):
    """Seeds as dots, their mean with its standard error beside; named: (x, case)."""
    means = []
    for x, name in named:
        values = unit * of_case(results, name, column)
        ax.plot([x] * len(values), values, f"{colour}.", ms=4, alpha=0.6)
        error = values.std(ddof=1) / math.sqrt(len(values)) if len(values) > 1 else 0
        means.append((x, values.mean(), error))
    x, mean, error = zip(*means, strict=True)
    ax.errorbar(x, mean, yerr=error, fmt=f"{colour}o-", ms=5, lw=1, capsize=3)


def plot_pair(results, name, named, label, log):
    named = [(x, case) for x, case in named if rows_of(results, case)]
    figure, axes = plt.subplots(1, 2, figsize=(11, 4), layout="constrained")
    for ax, (column, text, unit) in zip(axes, COLUMNS, strict=True):
        scatter(ax, results, named, column, unit)
        ax.set(xlabel=label, ylabel=text, xscale="log" if log else "linear")
        if log:
            ax.set_xticks([x for x, _ in named], [f"{x:g}" for x, _ in named])
            ax.minorticks_off()
        ax.grid(alpha=0.3)
    axes[0].axhspan(*BAND, color="0.9", zorder=0, label="experiments of the source")
    axes[0].legend()
    STUDY.save(figure, name)


def plot_spring(results):
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.8), layout="constrained")
    for name, colour, text in (("spring", "C0", "with tangential spring"), ("no_spring", "C3", "without")):
        for k, row in enumerate(rows_of(results, name)):
            axes[0].semilogy(row["time"], np.maximum(row["moving"], 1e-12), colour, lw=0.8, label=text if k == 0 else None)
            axes[1].plot(row["time"], 1e3 * np.array(row["heights"]), colour, lw=1)
            axes[2].plot(row["angle_times"], row["angles"], f"{colour}.-", lw=1, ms=4)
    after = PROPORTIONS["end"] - 0.3
    axes[0].set(ylabel="kinetic energy [J]")
    axes[1].set(ylabel="mean height of the rocks [mm]", xlim=(after, None), ylim=(0, 30))
    axes[2].set(ylabel="angle of repose [degrees]", ylim=(0, None))
    if axes[0].lines:
        axes[0].legend()
    for ax in axes:
        ax.set_xlabel("time [s]")
        ax.grid(alpha=0.3)
    STUDY.save(figure, "spring.png")


def rows_of(results, name):
    return [row for row in results["rows"] if row["case"] == name]


def creep_table(results):
    """How the piles change during the last CREEP seconds of the long runs."""
    lines = []
    for name, text in (("spring", "with tangential spring"), ("no_spring", "without")):
        for row in rows_of(results, name):
            time, heights = np.array(row["time"]), np.array(row["heights"])
            late = time >= LONG - CREEP
            rate = np.polyfit(time[late], 1e3 * heights[late], 1)[0]
            angles = [angle for time, angle in zip(row["angle_times"], row["angles"], strict=True) if time >= LONG - CREEP - 1e-9]
            lines.append([text, row["seed"], f"{-rate:.2g}", f"{angles[0]:.2f}", f"{angles[-1]:.2f}", f"{row['rest']:.0e}"])
    return table(["", "seed", "mean height sinks by [mm/s]", f"angle {CREEP:g} s before the end", "at the end",
                  "kinetic energy at the end [J]"], lines)


def shown(values, digits):
    text = f"{values.mean():.{digits}f}"
    if len(values) > 1:
        text += f" ± {values.std(ddof=1) / math.sqrt(len(values)):.{digits}f} ({values.std(ddof=1):.{digits}f})"
    return text


def paired(results, name, reference):
    """Differences of a case from another with the same seeds: the same rock, sizes, places and orientations, where the case has not
    changed them. Angle [degrees], mean height and flow energy [%]."""
    others = {row["seed"]: row for row in rows_of(results, reference)}
    pairs = [(row, others[row["seed"]]) for row in rows_of(results, name) if row["seed"] in others]
    angle = np.array([row["angle"] - other["angle"] for row, other in pairs])
    return [angle, *(np.array([100 * (row[key] / other[key] - 1) for row, other in pairs]) for key in ("height", "flow"))]


def differences_table(results, cases_and_texts, reference):
    lines = []
    for name, text in cases_and_texts:
        differences = paired(results, name, reference)
        if len(differences[0]):
            lines.append([text, len(differences[0]), *(shown(values, 1) for values in differences)])
    return table(["", "seeds", "angle [degrees]", "mean height [%]", "flow energy [%]"], lines)


def numbers(results):
    lines = []
    for name in dict.fromkeys(row["case"] for row in results["rows"]):
        column = {key: of_case(results, name, key) for key in ("angle", "flow", "peak", "height", "coordination", "rest",
                                                               "residual", "balance", "deepest", "seconds")}
        lines.append([name.replace("_", " "), len(column["angle"]), shown(column["angle"], 1), shown(1e3 * column["flow"], 2),
                      shown(1e3 * column["peak"], 1), shown(1e3 * column["height"], 1), shown(column["coordination"], 2),
                      f"{column['rest'].max():.0e}", f"{1e3 * column['residual'].mean():.1f}", f"{column['balance'].max():.0e}",
                      f"{1e3 * column['deepest'].max():.1f}", time_of(column["seconds"])])
    return table(["case", "runs", "angle [degrees]", "flow energy [mJ]", "peak [mJ]", "mean height [mm]", "coordination number",
                  "kinetic energy at the end [J]", "fit residual [mm]", "error of the balance", "deepest [mm]",
                  "processor time [s]"], lines)


def time_of(seconds):
    """Mean over the runs that were not broken off."""
    known = seconds[~np.isnan(seconds)]
    return f"{known.mean():.0f}" if len(known) else ""


def mean_seconds(results, name, timed):
    """Of a case; of all runs where none of it is known."""
    known = [row["seconds"] for row in rows_of(results, name) if row["seconds"] is not None] or timed
    return np.mean(known) if known else math.nan


def make_page(results):
    plot_pair(results, "resolution.png", [(n, f"triangles_{n}") for n in TRIANGLES], "triangles of a rock", True)
    named = sorted([(mu, f"friction_{mu:g}") for mu in FRICTION] + [(0.39, "triangles_40")])
    plot_pair(results, "friction.png", named, "friction between rocks", False)
    plot_spring(results)
    timed = [row["seconds"] for row in results["rows"] if row["seconds"] is not None]
    seconds = sum(seeds * mean_seconds(results, name, timed) for name, (_, seeds) in cases().items())
    finest, usual = f"triangles_{TRIANGLES[-1]}", "triangles_40"
    triangles = [(f"triangles_{n}", f"{n} triangles") for n in TRIANGLES[:-1]]
    changed = [(name, name.replace("_", " ")) for name in cases() if name.split("_")[0] not in ("triangles", "no", "spring")]
    texts = {"table": numbers(results), "creep": creep_table(results),
             "differences": differences_table(results, triangles, finest), "changes": differences_table(results, changed, usual),
             "minutes": f"{seconds / 60:.0f}", "half": f"{seconds / 120:.0f}",
             "runs": str(len(results["rows"])), "planned": str(results["planned"]), "timed": str(len(timed)),
             "long": f"{LONG:g}", "reach": f"{200 * PROPORTIONS['scale']:.0f}", "top": f"{75 * PROPORTIONS['scale']:.1f}",
             "mass": f"{1e3 * results['rows'][0]['mass']:.0f}",
             "measured": f"{min(row['measured_step'] for row in results['rows']):.1e}"}
    return texts | {key: str(value) for key, value in results["proportions"].items()}


if __name__ == "__main__":
    STUDY.main(compute, make_page, collect)
