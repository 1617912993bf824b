"""Hard cases over the time step, and bodies at rest over a million steps: makes README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment rests for a twentieth of the steps. A study that was broken off goes on where it stopped.
"""

import math
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import PROGRAM, QUICK, Study, output_of, plt, table, write_scene  # noqa: E402
from cases import cases, rests  # noqa: E402
from run_folder import Run  # noqa: E402

STUDY = Study(__file__)
FRACTIONS = (0.05, 0.1, 0.2, 0.35, 0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.4, 1.7, 2.0, 2.4, 2.8)
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
        "lost": float((mechanical[0] - mechanical[-1]) / turned_over),
        "balance": abs(summary["energy_error"]),
        "measured": summary["counters"]["smallest_critical_step"],
        "indentation": summary["counters"]["largest_indentation"],
        "contacts": summary["counters"]["contacts"],
        "seconds": summary["processor_seconds"], "steps": summary["num_steps"],
    }


def appears(run, finest):
    """Energy above the start, more than at the smallest step, where it is the force law's."""
    return run["appeared"] - max(finest["appeared"], 0)


def is_left(run, finest):
    """Energy at the end, more than at the smallest step: what is gained here may be less than was lost before."""
    return finest["lost"] - run["lost"]


def largest_step(result, energy):
    """Largest fraction of the predicted step up to which no run has more of this energy than BAND; None if all of the scan."""
    for before, fraction, run in zip((0, *FRACTIONS), FRACTIONS, result["runs"], strict=False):
        if run is None or energy(run, result["runs"][0]) > BAND:
            return before
    return None


def rest(name, scene, floor):
    """A case over many steps of the automatic size, every 1000th of them in its series."""
    path = STUDY.runs / "rest" / f"{name}.yaml"
    step = 0.5 * predicted_step(write_scene(path, scene))
    end = REST_STEPS * step
    output = {"series": 1000 * step, "frames": end, "checkpoint": 50_000 * step}
    changed = scene | {"time": {"end": end, "step": step}, "output": output}
    return measure_rest(STUDY.run(write_scene(path, changed), f"rest/{name}"), changed, floor)


def measure_rest(member, scene, floor):
    run, summary = Run(member.folder), member.summary()
    series = run.series()
    moving = series["kinetic"] + series["rotational"]
    half = len(moving) // 2
    weight = summary["mass"] * 9.81
    return {
        "time_step": summary["time_step"], "step": series["step"].tolist(), "moving": (moving / (0.1 * weight)).tolist(),
        "potential": ((series["potential"] - series["potential"][-1]) / (0.1 * weight)).tolist(),
        "drift": float(abs(series["potential"][-1] - series["potential"][half]) / weight),
        "kinetic": float(moving[half:].max() / (0.1 * weight)), "seconds": summary["processor_seconds"],
        "particles": summary["particles"],
    } | contacts_of(run, summary["particles"], [wall["name"] for wall in scene["walls"]].index(floor))


def contacts_of(run, num_particles, floor):
    """Numbers of contacts at the end, and of layers: bodies in the shortest chain of contacts from the floor to the body that has
    the longest."""
    frames = run.surfaces("contacts")
    last = frames.read(len(frames.times) - 1)
    pairs = list(zip(last["i"].tolist(), last["j"].tolist(), strict=True))
    of_bodies = [pair for pair in pairs if max(pair) < num_particles]
    layer = {i for i, j in pairs if j == num_particles + floor}
    reached, layers = set(layer), 0
    while layer:
        layers += 1
        layer = {b for i, j in of_bodies for a, b in ((i, j), (j, i)) if a in layer} - reached
        reached |= layer
    return {"contacts": len(pairs), "contacts_of_bodies": len(of_bodies), "layers": layers, "in_layers": len(reached)}


def compute():
    results = {"cases": {}, "rest": {}}
    for name, (_, scene) in cases().items():
        print(f"== {name}", flush=True)
        results["cases"][name] = scan(name, scene)
    for name, (_, scene, floor) in rests().items():
        print(f"== {name} at rest", flush=True)
        results["rest"][name] = rest(name, scene, floor)
    return results


def plot_scan(results):
    """Maps of the cases over the time step; numbers: powers of ten of the balance, percent of the energy."""
    figure, axes = plt.subplots(1, 2, figsize=(13, 5.4), layout="constrained", sharey=True)
    names = list(results["cases"])
    runs = [result["runs"] for result in results["cases"].values()]
    finest = [row[0] for row in runs]
    balance = np.array([[math.log10(max(run["balance"], 1e-16)) if run else math.nan for run in row] for row in runs])
    energy = 100 * np.array([[max(appears(run, least), is_left(run, least)) if run else math.nan for run in row]
                             for row, least in zip(runs, finest, strict=True)])
    shown = axes[0].imshow(balance, cmap="viridis", aspect="auto")
    figure.colorbar(shown, ax=axes[0], label="power of ten")
    shown = axes[1].imshow(np.clip(energy, 0, 20), cmap="Reds", aspect="auto")
    figure.colorbar(shown, ax=axes[1], label="percent of the energy turned over, 20: or more")
    for row in range(len(names)):
        for column in range(len(FRACTIONS)):
            axes[0].text(column, row, f"{balance[row, column]:.0f}", ha="center", va="center", fontsize=7,
                         color="k" if balance[row, column] > -7 else "w")
            if energy[row, column] > 100 * BAND:
                above = appears(runs[row][column], finest[row]) > BAND
                axes[1].text(column, row, f"{energy[row, column]:.0f}", ha="center", va="center", fontsize=7,
                             weight="bold" if above else "normal", color="w" if energy[row, column] > 12 else "k")
    axes[0].set_title("error of the balance")
    axes[1].set_title("energy too much (bold: above that of the start)")
    axes[0].set_yticks(range(len(names)), names)
    for ax in axes:
        ax.set_xticks(range(len(FRACTIONS)), [f"{f:g}" for f in FRACTIONS], fontsize=8)
        ax.set_xlabel("time step over the predicted critical step")
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


def shape_text(shape):
    if shape["source"] == "box":
        sizes = [f"{size:g}" for size in np.broadcast_to(shape["size"], 3)]
        return f"cube of {sizes[0]} m" if len(set(sizes)) == 1 else f"box {' x '.join(sizes)} m"
    if shape["source"] == "turned":
        radii = [corner["radius"] for corner in shape["profile"]]
        return f"ring of radii {min(radii):g} and {max(radii):g} m"
    return f"{shape['source']} of {shape['size']:g} m"


def setup_table():
    """What the scenes say, case by case."""
    lines = []
    for name, (_, scene) in cases().items():
        shapes = {shape["name"]: shape for shape in scene["shapes"]}
        (group,) = scene["particles"]
        bodies = group["bodies"]
        (law,), (material,) = scene["contact_laws"], scene["materials"]
        places = ["(" + ", ".join(f"{x:g}" for x in body["position"]) + ")" for body in bodies]
        turns = [f"{2 * math.degrees(math.acos(body['orientation'][0])):.0f}" for body in bodies]
        speeds = [f"{np.linalg.norm(body['velocity']):g}" for body in bodies]
        gravity = "0" if not any(scene["gravity"]) else "(" + ", ".join(f"{g:g}" for g in scene["gravity"]) + ")"
        lines.append([
            name, f"{len(bodies)} x " * (len(bodies) > 1) + shape_text(shapes[group["shape"]]),
            " and ".join(places) if len(places) <= 2 else f"{places[0]} to {places[-1]}",
            " and ".join(dict.fromkeys(turns)), " and ".join(dict.fromkeys(speeds)), gravity,
            f"{material['youngs_modulus'] / 1e6:g}", f"{law['friction_coefficient']:g}", f"{law['restitution_coefficient']:g}",
            f"{scene['time']['end']:g}"])
    return table(["case", "bodies", "centres at the start [m]", "turned by [degrees]", "speed [m/s]", "gravity [m/s²]", "E [MPa]",
                  "friction", "restitution", "end [s]"], lines)


def step_text(fraction):
    return f"> {FRACTIONS[-1]:g}" if fraction is None else f"{fraction:g}"


def cases_table(results):
    rows = []
    for name, (text, _) in cases().items():
        result = results["cases"][name]
        finest = result["runs"][0]
        at_half = result["runs"][FRACTIONS.index(0.5)]
        rows.append([name, text, f"{result['critical']:.2e}", f"{finest['measured'] / result['critical']:.2f}",
                     f"{at_half['balance']:.1e}" if at_half else "failed",
                     f"{finest['appeared']:.3f}", f"{1e3 * finest['indentation']:.2f}",
                     step_text(largest_step(result, appears)), step_text(largest_step(result, is_left))])
    return table(["case", "what", "predicted step [s]", "measured / predicted", "balance at 0.5", "appeared", "deepest [mm]",
                  "nothing appears up to", "no more is left up to"], rows)


def rest_table(results):
    rows = []
    for name, (text, _, _) in rests().items():
        result = results["rest"][name]
        rows.append([name, text, f"{int(result['step'][-1]):,}".replace(",", " "), f"{result['time_step']:.2e}",
                     *(result[key] for key in ("particles", "layers", "contacts", "contacts_of_bodies")),
                     f"{result['kinetic']:.1e}", f"{1e9 * result['drift']:.2g}"])
    return table(["scene", "at rest", "steps", "step [s]", "bodies", "layers", "contacts", "of them between bodies",
                  "largest kinetic energy over m g 0.1 m, second half", "mean height lost in the second half [nm]"], rows)


def make_page(results):
    plot_scan(results)
    plot_rest(results)
    seconds = sum(result["seconds"] for result in results["rest"].values())
    seconds += sum(run["seconds"] for result in results["cases"].values() for run in result["runs"] if run)
    return {"setup": setup_table(), "cases": cases_table(results), "rest": rest_table(results), "minutes": f"{seconds / 60:.0f}"}


if __name__ == "__main__":
    STUDY.main(compute, make_page)
