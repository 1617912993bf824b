"""Elastic collisions of two spheres as polyhedra, of two rocks, and what the force laws do to their kinetic energy: makes
README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment computes with fewer pairs and meshes. A study that was broken off goes on where it stopped.
"""

import json
import math
import sys
import threading
import time
from pathlib import Path

import numpy as np
from matplotlib.ticker import NullFormatter

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import BUILD, QUICK, Study, build, in_parallel, output_of, plt, table  # noqa: E402

STUDY = Study(__file__)
STORE = STUDY.runs / "lines.jsonl"  # a line for each case that is finished
PAIRS = 500 if QUICK else 10000
SPHERES = (40, 84, 180) if QUICK else (40, 84, 180, 400, 1000)
ROCKS = (10, 40, 70) if QUICK else (10, 40, 70, 150, 300, 1000)
SPHERE_MODULI = (1e6, 21.5e6, 1e8, 1e9)
ROCK_MODULI = (21.5e6, 464e6)
HERTZ = "model: hertz_mindlin"
LAWS = (  # law, name in the page
    (HERTZ, "hertz_mindlin"),
    ("model: energy_conserving", "energy_conserving, p = 5/4"),
    ("model: energy_conserving, energy_exponent: 1, stiffness_factor: 0.03", "energy_conserving, p = 1"),
)
STEPS = (50, 200, 800)


def contact_time(modulus):
    """Of two true spheres, after Hertz; the same as in collisions_study.c."""
    effective, mass = modulus / (2 * (1 - 0.25**2)), 4 / 3 * math.pi * 0.1**3 * 2500 / 2
    return 2.94328 * (15 * mass * 100 / (16 * effective * math.sqrt(0.05))) ** 0.4 / 10


def cases():
    """Arguments of the program, the quick ones first."""
    found = []
    for modulus in SPHERE_MODULI:
        # corners meet earlier and flat faces later than spheres, by up to 4 ms
        end = round(1.5 + 0.004 / contact_time(modulus), 3)
        found += [("sphere" if n == 0 else f"sphere:{n}", modulus, HERTZ, PAIRS if n else 1, 200, 0, end)
                  for n in (0, *SPHERES)]
    for modulus in ROCK_MODULI:
        end = round(3 + 0.015 / contact_time(modulus), 3)
        found += [(f"rock:{n}", modulus, HERTZ, PAIRS, 200, 0, end) for n in ROCKS]
    for shape in ("cube", "rock:40"):
        for law, _ in LAWS:
            found += [(shape, 21.5e6, law, PAIRS // 10, steps, 1, 6) for steps in STEPS]
    return sorted(found, key=lambda c: int(c[0].partition(":")[2] or 0))


def key(case):
    return json.dumps([str(part) for part in case])


def stored():
    if not STORE.exists():
        return {}
    lines = [json.loads(line) for line in STORE.read_text().splitlines() if line.endswith("}")]
    return {line["key"]: line for line in lines}


def compute():
    build("collisions_study")
    done, lock = stored(), threading.Lock()
    todo = [case for case in cases() if key(case) not in done]

    def one(case):
        begin = time.perf_counter()
        line = json.loads(output_of([BUILD / "studies/collisions_study", *case]).splitlines()[-1])
        line |= {"key": key(case), "seconds": time.perf_counter() - begin}
        with lock, open(STORE, "a") as file:
            file.write(json.dumps(line) + "\n")

    in_parallel(one, todo)
    done = stored()
    return {"lines": [done[key(case)] for case in cases()]}


def select(lines, prefix, modulus, law=HERTZ, offset=0):
    """Lines by number of triangles; 0: the true sphere."""
    chosen = [x for x in lines if x["shape"].split(":")[0] == prefix and x["modulus"] == modulus and x["law"] == law
              and x["offset"] == offset]
    return sorted(chosen, key=lambda x: (x["triangles"], x["steps"]))


def fitted_order(x, y):
    """p of y ~ x^-p and its standard error, by least squares in logarithms."""
    if len(x) < 3:
        return math.nan, math.nan
    coefficients, covariance = np.polyfit(np.log(x), np.log(y), 1, cov=True)
    return -coefficients[0], math.sqrt(covariance[0, 0])


def plain_ticks(ax, places, names=None):
    """The values themselves at the logarithmic x axis."""
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_xticks(places, names or [f"{place:g}" for place in places])
    ax.grid(alpha=0.3)


def modulus_name(modulus):
    return f"{modulus / 1e6:g} MPa"


def plot_energy_over_time(lines, prefix, moduli, name, shown):
    figure, axes = plt.subplots(1, len(moduli), figsize=(3.3 * len(moduli) + 1, 3.8), layout="constrained", sharey=True)
    for ax, modulus in zip(axes, moduli):
        for k, x in enumerate(y for y in select(lines, prefix, modulus) if y["triangles"] in shown):
            time, mean, deviation = (np.array(x[column]) for column in ("time", "mean", "deviation"))
            colour = "k" if x["triangles"] == 0 else f"C{k - (prefix == 'sphere')}"
            ax.plot(1e3 * time, mean, color=colour, lw=1.3, label="true sphere" if x["triangles"] == 0 else x["triangles"])
            for side in (mean - deviation, mean + deviation):
                ax.plot(1e3 * time, side, color=colour, lw=0.7, ls=":")
        ax.set(xlabel="time [ms]", title=f"E = {modulus_name(modulus)}")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("kinetic energy over that at the start")
    axes[-1].legend(title="triangles", fontsize=8)
    STUDY.save(figure, name)


def farthest(column):
    """Largest distance over time of two lines' columns, which have the same times."""
    return lambda x, reference: max(abs(a - b) for a, b in zip(x[column], reference[column]))


def plot_convergence(lines, prefix, moduli, quantities, name):
    """Quantities by name as functions of a line and of the true sphere or, for rocks, the finest line; the fitted orders as
    rows of a table."""
    figure, axes = plt.subplots(1, len(quantities), figsize=(5 * len(quantities), 4), layout="constrained")
    rows = []
    for k, modulus in enumerate(moduli):
        chosen = select(lines, prefix, modulus)
        reference = chosen.pop(0 if chosen[0]["triangles"] == 0 else -1)
        row = [modulus_name(modulus)]
        for ax, (label, quantity) in zip(axes, quantities):
            n = np.array([x["triangles"] for x in chosen])
            y = np.array([quantity(x, reference) for x in chosen])
            order, error = fitted_order(n, y)
            ax.loglog(n, y, f"C{k}o-", ms=4, lw=1, label=f"{modulus_name(modulus)}: order {order:.2f}")
            ax.set(xlabel="triangles", ylabel=label)
            plain_ticks(ax, [x["triangles"] for x in chosen])
            ax.legend(fontsize=8)
            row.append(f"{order:.2f} ± {error:.2f}")
        rows.append(row)
    STUDY.save(figure, name)
    return rows


def numbers(lines, prefix, moduli):
    rows = []
    for modulus in moduli:
        chosen = select(lines, prefix, modulus)
        reference = chosen[0 if chosen[0]["triangles"] == 0 else -1]
        for x in chosen:
            ratio = x["ratio"]
            rows.append([modulus_name(modulus), x["triangles"] or "true sphere", f"{farthest('mean')(x, reference):.4f}",
                         f"{max(x['deviation']):.4f}", f"{ratio['median']:.4f}", f"{ratio['low']:.4f} to {ratio['high']:.4f}",
                         f"{ratio['min']:.3f} to {ratio['max']:.3f}", f"{x['indentation']:.4f}", x["still_touching"]])
    return table(["E", "triangles", "distance of the mean", "largest deviation", "after/before, median", "nine tenths within",
                  "all within", "deepest [m]", "in contact at the end"], rows)


def plot_laws(lines):
    """Change of the kinetic energy over the time step, by law, and rows of a table."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", sharey=True)
    rows = []
    for ax, shape in zip(axes, ("cube", "rock")):
        for k, (law, name) in enumerate(LAWS):
            chosen = select(lines, shape, 21.5e6, law, offset=1)
            step = np.array([1 / x["steps"] for x in chosen])
            rms = np.array([x["ratio"]["rms"] for x in chosen])
            ax.loglog(step, rms, f"C{k}o-", ms=4, label=name)
            order = -fitted_order(step, rms)[0]
            finest = chosen[-1]
            rows.append([shape if shape == "cube" else "rock of 40", name, finest["pairs"],
                         *(f"{x['ratio']['rms']:.1e}" for x in sorted(chosen, key=lambda x: x["steps"])), f"{order:.2f}",
                         f"{finest['ratio']['low']:.5f} to {finest['ratio']['high']:.5f}",
                         f"{finest['ratio']['min']:.5f} to {finest['ratio']['max']:.5f}"])
        ax.loglog(step, 1e-3 * (step / step[0]) ** 2, "k:", label="second order")
        ax.set(xlabel="time step over contact time", title="cubes" if shape == "cube" else "rocks of 40 triangles")
        plain_ticks(ax, [1 / n for n in STEPS], [f"1/{n}" for n in STEPS])
    axes[0].set_ylabel("root mean square of energy after/before - 1")
    axes[0].legend(fontsize=8)
    STUDY.save(figure, "laws.png")
    return table(["shape", "law", "pairs", *(f"{n} steps" for n in STEPS), "order", "nine tenths within", "all within"], rows)


def law_cost(lines):
    """Time with energy_conserving over that with hertz_mindlin."""
    seconds = {(x["shape"], x["steps"], x["law"]): x["seconds"] for x in lines if x["offset"] == 1}
    return np.median([value / seconds[shape, steps, HERTZ] for (shape, steps, law), value in seconds.items() if law == LAWS[1][0]])


def make_page(results):
    lines = results["lines"]
    plot_energy_over_time(lines, "sphere", SPHERE_MODULI, "two_spheres.png", (0, 40, 84, 180, 1000))
    spheres = plot_convergence(lines, "sphere", SPHERE_MODULI, (
        ("mean, largest distance from the true sphere", farthest("mean")),
        ("largest standard deviation", lambda x, _: max(x["deviation"]))), "two_spheres_convergence.png")
    plot_energy_over_time(lines, "rock", ROCK_MODULI, "two_rocks.png", (10, 40, 70, 1000))
    rocks = plot_convergence(lines, "rock", ROCK_MODULI, (
        ("mean, largest distance from the finest", farthest("mean")),
        ("deviation, largest distance from the finest", farthest("deviation"))), "two_rocks_convergence.png")
    orders = ["E", "order of the mean", "order of the standard deviation"]
    return {
        "spheres": numbers(lines, "sphere", SPHERE_MODULI), "sphere_orders": table(orders, spheres),
        "rocks": numbers(lines, "rock", ROCK_MODULI), "rock_orders": table(orders, rocks), "laws": plot_laws(lines),
        "cost": f"{law_cost(lines):.2f}",
        "minutes": f"{sum(x['seconds'] for x in lines) / 60:.0f}", "pairs": f"{PAIRS}",
    }


if __name__ == "__main__":
    STUDY.main(compute, make_page)
