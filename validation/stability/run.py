"""Hard cases over the time step, and bodies at rest over a million steps: makes README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment rests for a twentieth of the steps. A study that was broken off goes on where it stopped.
"""

import re
import sys
from pathlib import Path

import numpy as np
from matplotlib.ticker import NullFormatter

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import PROGRAM, QUICK, Study, output_of, plt, table, write_scene  # noqa: E402
from cases import cases, rests  # noqa: E402
from run_folder import Run  # noqa: E402

STUDY = Study(__file__)
FRACTIONS = (0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8)
REST_STEPS = 50_000 if QUICK else 1_000_000
BAND = 0.01  # share of the energy that may appear


def predicted_step(path):
    """Critical step that scree check tells of a scene."""
    return float(re.search(r"of the critical step of (\S+) s", output_of([PROGRAM, "check", path]))[1])


def scan(name, scene):
    """The case at each fraction of the predicted step; a run that failed is None."""
    path = write_scene(STUDY.runs / name / "scene.yaml", scene)
    critical = predicted_step(path)
    steps = [f"{fraction * critical:.6g}" for fraction in FRACTIONS]
    ensemble = STUDY.ensemble(path, name, [(["time.step"], steps)])
    ensemble.run()
    return {"critical": critical, "runs": [measure(member) for member in ensemble.members]}


def measure(member):
    if not member.is_finished():
        return None
    series, summary = Run(member.folder).series(), member.summary()
    moving = series["kinetic"] + series["rotational"]
    mechanical = moving + series["potential"]
    turned_over = max(moving.max(), np.ptp(mechanical))
    return {
        "appeared": float((mechanical - mechanical[0]).max() / turned_over),
        "balance": abs(summary["energy_error"]),
        "measured": summary["counters"]["smallest_critical_step"],
        "indentation": summary["counters"]["largest_indentation"],
        "seconds": summary["processor_seconds"], "steps": summary["num_steps"],
    }


def is_stable(run, finest):
    return run is not None and run["appeared"] < max(finest["appeared"], 0) + BAND


def largest_stable(result):
    """Largest fraction of the predicted step up to which every run is stable."""
    largest = 0
    for fraction, run in zip(FRACTIONS, result["runs"], strict=True):
        if not is_stable(run, result["runs"][0]):
            break
        largest = fraction
    return largest


def rest(name, scene):
    """A case over a million steps of the automatic size, with 1000 rows of its series."""
    path = STUDY.runs / "rest" / f"{name}.yaml"
    step = 0.5 * predicted_step(write_scene(path, scene))
    end = REST_STEPS * step
    changed = scene | {"time": {"end": end, "step": step}, "output": {"series": end / 1000, "frames": 0, "checkpoint": end / 20}}
    member = STUDY.run(write_scene(path, changed), f"rest/{name}")
    series, summary = Run(member.folder).series(), member.summary()
    moving = series["kinetic"] + series["rotational"]
    half = len(moving) // 2
    scale = summary["mass"] * 9.81 * 0.1
    return {
        "step": series["step"].tolist(), "moving": (moving / scale).tolist(),
        "potential": ((series["potential"] - series["potential"][-1]) / scale).tolist(),
        "drift": float(abs(series["potential"][-1] - series["potential"][half]) / (summary["mass"] * 9.81)),
        "kinetic": float(moving[half:].max() / scale), "seconds": summary["processor_seconds"],
        "contacts": summary["counters"]["contacts"], "particles": summary["particles"],
    }


def compute():
    results = {"cases": {}, "rest": {}}
    for name, (_, scene) in cases().items():
        print(f"== {name}", flush=True)
        results["cases"][name] = scan(name, scene)
    for name, (_, scene) in rests().items():
        print(f"== {name} at rest", flush=True)
        results["rest"][name] = rest(name, scene)
    return results


def plot_scan(results):
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.8), layout="constrained", sharex=True)
    for k, (name, result) in enumerate(results["cases"].items()):
        style = f"C{k % 10}{'o-' if k < 10 else 's--'}"
        good = [(f, run) for f, run in zip(FRACTIONS, result["runs"], strict=True) if run]
        fractions = [f for f, _ in good]
        axes[0].loglog(fractions, [max(run["balance"], 1e-16) for _, run in good], style, ms=3, lw=1, label=name)
        excess = [run["appeared"] - max(result["runs"][0]["appeared"], 0) for _, run in good]
        axes[1].semilogx(fractions, np.clip(excess, -0.02, 0.2), style, ms=3, lw=1)
    axes[1].axhline(BAND, color="k", lw=0.8, ls=":")
    axes[0].set(ylabel="error of the energy balance")
    axes[1].set(ylabel="energy that appears, less that at the finest step (0.2: or more)")
    for ax in axes:
        ax.set_xlabel("time step over the predicted critical step")
        ax.xaxis.set_minor_formatter(NullFormatter())
        ax.set_xticks(FRACTIONS, [f"{f:g}" for f in FRACTIONS])
        ax.grid(alpha=0.3)
    figure.legend(*axes[0].get_legend_handles_labels(), fontsize=8, loc="outside right center")
    STUDY.save(figure, "time_step.png")


def plot_rest(results):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4), layout="constrained")
    for name, result in results["rest"].items():
        step = np.array(result["step"])
        axes[0].loglog(step[1:], np.maximum(result["moving"], 1e-40)[1:], lw=0.8, label=name)
        axes[1].loglog(step[1:-1], np.maximum(0.1 * np.abs(result["potential"]), 1e-18)[1:-1], lw=0.8, label=name)
    axes[0].set(xlabel="steps", ylabel="kinetic energy over m g 0.1 m")
    axes[1].set(xlabel="steps", ylabel="mean height, distance from that at the end [m]")
    axes[0].legend()
    for ax in axes:
        ax.grid(alpha=0.3)
    STUDY.save(figure, "rest.png")


def stable_texts(result):
    """Largest stable step over the predicted and the measured one; all of the scan: a lower bound."""
    largest = largest_stable(result)
    bound = "> " if largest == FRACTIONS[-1] else ""
    return f"{bound}{largest:g}", f"{bound}{largest * result['critical'] / result['runs'][0]['measured']:.2f}"


def cases_table(results):
    rows = []
    for name, (text, _) in cases().items():
        result = results["cases"][name]
        finest = result["runs"][0]
        at_half = result["runs"][FRACTIONS.index(0.5)]
        rows.append([name, text, f"{result['critical']:.2e}", f"{finest['measured'] / result['critical']:.2f}",
                     f"{at_half['balance']:.1e}" if at_half else "failed",
                     f"{finest['appeared']:.3f}", f"{1e3 * finest['indentation']:.2f}", *stable_texts(result)])
    return table(["case", "what", "predicted step [s]", "measured / predicted", "balance at 0.5", "appeared",
                  "deepest [mm]", "largest stable / predicted", "largest stable / measured"], rows)


def rest_table(results):
    rows = [[text, f"{int(results['rest'][name]['step'][-1]):,}".replace(",", " "), results["rest"][name]["contacts"],
             f"{results['rest'][name]['kinetic']:.1e}", f"{1e9 * results['rest'][name]['drift']:.2g}"]
            for name, (text, _) in rests().items()]
    return table(["at rest", "steps", "contacts", "largest kinetic energy over m g 0.1 m, second half",
                  "mean height lost in the second half [nm]"], rows)


def make_page(results):
    plot_scan(results)
    plot_rest(results)
    seconds = sum(result["seconds"] for result in results["rest"].values())
    seconds += sum(run["seconds"] for result in results["cases"].values() for run in result["runs"] if run)
    return {"cases": cases_table(results), "rest": rest_table(results), "minutes": f"{seconds / 60:.0f}"}


if __name__ == "__main__":
    STUDY.main(compute, make_page)
