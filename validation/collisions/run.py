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
from pathlib import Path

import numpy as np
from matplotlib.ticker import NullFormatter

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import BUILD, QUICK, Study, build, in_parallel, output_of, plt, table  # noqa: E402

STUDY = Study(__file__)
STORE = STUDY.runs / "lines.jsonl"  # a line for each case that is finished
PAIRS = 500 if QUICK else 10000
SINGLE_PAIRS = 100 if QUICK else 500  # rocks of which the energy of every pair is kept
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
STEPS = (50, 200, 800) if QUICK else (50, 200, 800, 3200)


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
    found += [rock_case(n, modulus, PAIRS) for modulus in ROCK_MODULI for n in ROCKS]
    for shape in ("cube", "rock:40"):
        for law, _ in LAWS:
            # what hertz_mindlin does is seen at three steps
            found += [(shape, 21.5e6, law, PAIRS // 10, steps, 1, 6) for steps in STEPS if law != HERTZ or steps <= 800]
    return sorted(found, key=lambda c: int(c[0].partition(":")[2] or 0))


def rock_case(triangles, modulus, pairs):
    return f"rock:{triangles}", modulus, HERTZ, pairs, 200, 0, round(3 + 0.015 / contact_time(modulus), 3)


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
        line = json.loads(output_of([BUILD / "studies/collisions_study", *case]).splitlines()[-1])
        line |= {"key": key(case)}
        with lock, open(STORE, "a") as file:
            file.write(json.dumps(line) + "\n")

    in_parallel(one, todo)
    done = stored()
    single = STUDY.kept("single_pairs", lambda: [row for modulus in ROCK_MODULI for row in rocks_pair_by_pair(modulus)])
    return {"lines": [done[key(case)] for case in cases()], "single_pairs": single}


def rocks_pair_by_pair(modulus):
    """Rows by number of triangles, of what takes the energies of single pairs: over time, the deviation of a pair's difference
    from the same pair of the finest rocks; at the end, after over before for all pairs and for those that have parted."""
    energies, seconds = {}, {}

    def one(triangles):
        path = STUDY.runs / f"pairs_{triangles}_{modulus:g}"
        told = output_of([BUILD / "studies/collisions_study", *rock_case(triangles, modulus, SINGLE_PAIRS), path])
        seconds[triangles] = json.loads(told.splitlines()[-1])["seconds"]
        energies[triangles] = np.fromfile(path).reshape(-1, SINGLE_PAIRS)
        path.unlink()

    in_parallel(one, ROCKS)
    rows = []
    for triangles in ROCKS:
        *over_time, touches = energies[triangles]
        differences = np.array(over_time) - energies[ROCKS[-1]][:-1]
        rows.append({"modulus": modulus, "triangles": triangles, "pairs": SINGLE_PAIRS, "seconds": seconds[triangles],
                     "deviation": [float(f"{x:.6g}") for x in differences.std(axis=1, ddof=1)],
                     "all": extremes(over_time[-1]), "parted": extremes(over_time[-1][touches == 0])})
    return rows


def extremes(ratios):
    low, median, high = np.quantile(ratios, (0.05, 0.5, 0.95))
    return {"pairs": len(ratios), "min": ratios.min(), "low": low, "median": median, "high": high, "max": ratios.max()}


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
    """Of spheres the mean, and below it the difference from the true sphere; of rocks the mean. Dotted: a deviation to each
    side."""
    is_sphere = prefix == "sphere"
    figure, grid = plt.subplots(1 + is_sphere, len(moduli), figsize=(3.3 * len(moduli) + 1, 3.8 + 2.6 * is_sphere),
                                layout="constrained", sharex="col", squeeze=False)
    for k, modulus in enumerate(moduli):
        chosen = [x for x in select(lines, prefix, modulus) if x["triangles"] in shown]
        for n, x in enumerate(chosen):
            time, mean, deviation = (np.array(x[column]) for column in ("time", "mean", "deviation"))
            colour = "k" if x["triangles"] == 0 else f"C{n - is_sphere}"
            grid[0, k].plot(1e3 * time, mean, color=colour, lw=1.3, label=x["triangles"] or "true sphere")
            if is_sphere:
                mean = mean - np.array(chosen[0]["mean"])
                grid[1, k].plot(1e3 * time, mean, color=colour, lw=1.3)
            for side in (mean - deviation, mean + deviation):
                grid[-1, k].plot(1e3 * time, side, color=colour, lw=0.7, ls=":")
        grid[0, k].set(title=f"E = {modulus_name(modulus)}", ylim=(-0.05, 1.35 - 0.25 * is_sphere))
        grid[-1, k].set(xlabel="time [ms]")
        for ax in grid[:, k]:
            ax.grid(alpha=0.3)
    grid[0, 0].set_ylabel("kinetic energy over that at the start")
    if is_sphere:
        grid[1, 0].set_ylabel("the same, minus the true sphere")
    grid[0, -1].legend(title="triangles", fontsize=8)
    STUDY.save(figure, name)


def farthest(column):
    """Largest distance over time of two lines' columns, which have the same times."""
    return lambda x, reference: float(np.abs(np.subtract(x[column], reference[column])).max())


def distance_of_mean(x, reference, single_pairs):
    """With its standard error at that time. Pairs of rocks are the same in all meshes, so there the deviation is that of the
    differences of pairs; the true sphere has none."""
    differences = np.abs(np.subtract(x["mean"], reference["mean"]))
    place = int(differences.argmax())
    deviation = next((row["deviation"] for row in single_pairs
                      if x["shape"].startswith("rock") and (row["modulus"], row["triangles"]) == (x["modulus"], x["triangles"])), x["deviation"])
    return f"{differences[place]:.4f} ± {deviation[place] / math.sqrt(x['pairs']):.1g}" if differences[place] > 0 else "0"


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


def numbers(lines, prefix, moduli, single_pairs):
    rows = []
    for modulus in moduli:
        chosen = select(lines, prefix, modulus)
        reference = chosen[0 if chosen[0]["triangles"] == 0 else -1]
        for x in chosen:
            ratio = x["ratio"]
            rows.append([modulus_name(modulus), x["triangles"] or "true sphere", distance_of_mean(x, reference, single_pairs),
                         f"{max(x['deviation']):.4f}", f"{ratio['median']:.4f}", f"{ratio['low']:.4f} to {ratio['high']:.4f}",
                         f"{ratio['min']:.3f} to {ratio['max']:.3f}", f"{x['indentation']:.4f}", x["still_touching"]])
    return table(["E", "triangles", "distance of the mean", "largest deviation", "after/before, median", "nine tenths within",
                  "all within", "deepest [m]", "in contact at the end"], rows)


def parted_table(single_pairs):
    rows = []
    for x in single_pairs:
        rows.append([modulus_name(x["modulus"]), x["triangles"], x["parted"]["pairs"]])
        for kind in ("all", "parted"):
            r = x[kind]
            rows[-1] += [f"{r['median']:.4f}", f"{r['low']:.4f} to {r['high']:.4f}", f"{r['min']:.3f} to {r['max']:.3f}"]
    return table(["E", "triangles", "parted", "median", "nine tenths within", "all within", "parted: median", "nine tenths within", "all within"], rows)


def away_from_one(line, low="min", high="max"):
    return max(abs(line["ratio"][low] - 1), abs(line["ratio"][high] - 1))


def plot_laws(lines):
    """Change of the kinetic energy over the time step, by law, and rows of a table."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", sharey=True)
    rows = []
    for ax, shape in zip(axes, ("cube", "rock")):
        for k, (law, name) in enumerate(LAWS):
            chosen = {x["steps"]: x for x in select(lines, shape, 21.5e6, law, offset=1)}
            step = np.array([1 / n for n in chosen])
            rms = np.array([x["ratio"]["rms"] for x in chosen.values()])
            largest = np.array([away_from_one(x) for x in chosen.values()])
            ax.loglog(step, rms, f"C{k}o-", ms=4, label=name)
            ax.loglog(step, largest, f"C{k}^:", ms=4, lw=0.8)
            order, error = fitted_order(step, rms)
            finest = chosen[max(chosen)]
            rows.append([shape if shape == "cube" else "rock of 40", name, finest["pairs"], f"{-order:.2f} ± {error:.2f}"])
            for values in (rms, largest):
                rows[-1] += [f"{dict(zip(chosen, values))[n]:.1e}" if n in chosen else "" for n in STEPS]
            most = away_from_one(finest, "low", "high")
            rows[-1].append(f"{most:.1e}" if most > 1e-9 else "below 1e-9")  # ratios are told to that
        ax.loglog([1 / n for n in STEPS], [2.5 / n**2 for n in STEPS], "k:", label="second order")
        ax.axhline(1e-6, color="0.6", lw=0.8)
        ax.set(xlabel="time step over contact time", title="cubes" if shape == "cube" else "rocks of 40 triangles")
        plain_ticks(ax, [1 / n for n in STEPS], [f"1/{n}" for n in STEPS])
    axes[0].set_ylabel("|energy after/before - 1|: r.m.s. (lines), largest (dotted)")
    axes[1].legend(fontsize=8)
    STUDY.save(figure, "laws.png")
    return table(["shape", "law", "pairs", "order of r.m.s.", *(f"r.m.s., {n} steps" for n in STEPS),
                  *(f"largest, {n}" for n in STEPS), "nine tenths within, finest"], rows)


def law_cost(lines):
    """Time with energy_conserving over that with hertz_mindlin."""
    seconds = {(x["shape"], x["steps"], x["law"]): x["seconds"] for x in lines if x["offset"] == 1}
    return np.median([value / seconds[shape, steps, HERTZ] for (shape, steps, law), value in seconds.items()
                      if law == LAWS[1][0] and (shape, steps, HERTZ) in seconds])


def make_page(results):
    lines, single = results["lines"], results["single_pairs"]
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
        "spheres": numbers(lines, "sphere", SPHERE_MODULI, single), "sphere_orders": table(orders, spheres),
        "rocks": numbers(lines, "rock", ROCK_MODULI, single), "parted": parted_table(single),
        "rock_orders": table(orders, rocks), "laws": plot_laws(lines),
        "cost": f"{law_cost(lines):.2f}",
        "minutes": f"{sum(x['seconds'] or 0 for x in [*lines, *single]) / 60:.0f}", "pairs": f"{PAIRS}",
        "single_pairs": f"{SINGLE_PAIRS}", "remark": results.get("remark", ""),
    }


if __name__ == "__main__":
    STUDY.main(compute, make_page)
