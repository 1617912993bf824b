"""Elementary cases of single bodies against published values, closed forms and experiment: makes README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment computes the same; it takes minutes at most.
"""

import json
import math
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import BUILD, Study, build, output_of, plt, table  # noqa: E402

STUDY = Study(__file__)
ENERGY_LINE = r"(cubes|rocks), model: (.*), dt = (\S+) s: kinetic energy changed by (\S+) in (\d+)"

# Test 4, sticking: Al oxide on soda-lime glass, as printed in Chung & Ooi (2011)
EXPERIMENT = [(10, 0.675), (20, 0.599)]


def compute():
    build("elementary_study", "test_energy_conserving")
    return {"lines": [json.loads(line) for line in output_of([BUILD / "studies/elementary_study"]).splitlines()],
            "energy": re.findall(ENERGY_LINE, output_of([BUILD / "tests/test_energy_conserving"]))}


def select(lines, part, **wanted):
    return [x for x in lines if x["part"] == part and all(x[key] == value for key, value in wanted.items())]


def plot_force(lines):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained", sharey=True)
    for ax, law in zip(axes, ("hertz_mindlin", "linear_spring")):
        for k, line in enumerate(select(lines, "force", law=law)):
            depth, force = zip(*((1e6 * d, f) for d, f in line["points"]))
            ax.plot(depth, force, f"C{k}-", lw=1.6, label=f"e = {line['e']}")
        deepest = max(p[0] for p in select(lines, "force", law=law, e=1)[0]["points"])
        d = [deepest * k / 50 for k in range(51)]
        if law == "hertz_mindlin":
            expected = [4 / 3 * line["modulus"] * math.sqrt(line["radius"]) * x**1.5 for x in d]
        else:
            expected = [line["stiffness"] * x for x in d]
        ax.plot([1e6 * x for x in d], expected, "k:", label="closed form, elastic")
        ax.set(xlabel="indentation [µm]", title=law)
        ax.grid(alpha=0.3)
        ax.legend(fontsize=8)
    axes[0].set_ylabel("normal force [N]")
    STUDY.save(figure, "force_over_indentation.png")


def plot_test_4(lines):
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.2), layout="constrained")
    mu, e, speed, radius = 0.092, 0.98, 3.9, 0.0025
    angles = [0.5 * k for k in range(1, 180)]
    slides = [a for a in angles if math.tan(math.radians(a)) >= 3.5 * mu * (1 + e)]
    for k, solid in enumerate(("Al oxide", "Al alloy")):
        chosen = select(lines, "test_4", case=solid)
        x = [c["x"] for c in chosen]
        style = dict(color=f"C{k}", marker="os"[k], ms=4, ls="", label=f"scree, {solid}")
        axes[0].plot(x, [c["v_t_after"] / c["v_t"] for c in chosen], **style)
        axes[1].plot(x, [c["spin_after"] for c in chosen], **style)
        axes[2].plot(x, [math.degrees(math.atan2(c["slip_after"], c["v_n_after"])) for c in chosen], **style)
    tangent = [math.tan(math.radians(a)) for a in slides]
    axes[0].plot(slides, [1 - mu * (1 + e) / t for t in tangent], "k:", label="sliding throughout")
    axes[0].axhline(5 / 7, color="0.6", lw=0.8, label="rolling at the end")
    axes[0].plot(*zip(*EXPERIMENT), "k*", ms=9, label="experiment")
    spin = [2.5 * mu * (1 + e) * speed * math.cos(math.radians(a)) / radius for a in slides]
    axes[1].plot(slides, spin, "k:", label="sliding throughout")
    rebound = [math.degrees(math.atan2(t - 3.5 * mu * (1 + e), e)) for t in tangent]
    axes[2].plot(slides, rebound, "k:", label="sliding throughout")
    for ax, label in zip(axes, ("tangential restitution", "spin after [rad/s]", "rebound angle of the contact point [degrees]")):
        ax.set(xlabel="incident angle [degrees]", ylabel=label)
        ax.grid(alpha=0.3)
    axes[0].legend(fontsize=8)
    STUDY.save(figure, "oblique.png")


def plot_tests_5_and_6(lines):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    for ax, part, solids, e in ((axes[0], "test_5", ("steel", "polyethylene"), 1), (axes[1], "test_6", ("Al alloy", "nylon"), 0.5)):
        for k, solid in enumerate(solids):
            chosen = select(lines, part, case=solid)
            x = [c["slip"] / (c["mu"] * c["v_n"]) for c in chosen]
            y = [c["slip_after"] / (c["mu"] * c["v_n_after"]) for c in chosen]
            ax.plot(x, y, marker="os"[k], color=f"C{k}", ms=4, ls="", label=f"scree, {solid}")
        ends = [3.5 * (1 + e), max(x)]
        ax.plot(ends, [(value - 3.5 * (1 + e)) / e for value in ends], "k:", label="sliding throughout")
        ax.set(xlabel="$v_s/(\\mu v_n)$ before", ylabel="$v_s'/(\\mu v_n')$ after", title=part.replace("_", " "))
        ax.grid(alpha=0.3)
        ax.legend(fontsize=8)
    STUDY.save(figure, "contact_point.png")


def plot_drops(lines):
    figure, axes = plt.subplots(figsize=(6.5, 4.2), layout="constrained")
    for k, e in enumerate(sorted({x["e"] for x in select(lines, "drop")})):
        chosen = select(lines, "drop", e=e)
        axes.semilogy([c["bounce"] for c in chosen], [c["height"] for c in chosen], f"C{k}o", ms=5, label=f"e = {e}")
        axes.semilogy([c["bounce"] for c in chosen], [0.1 * e ** (2 * c["bounce"]) for c in chosen], f"C{k}:")
    axes.set(xlabel="bounce", ylabel="height [m]", title="Marks: scree; dotted: $e^{2k} h$")
    axes.grid(alpha=0.3)
    axes.legend()
    STUDY.save(figure, "drops.png")


def plot_energy(found):
    figure, axes = plt.subplots(figsize=(6.5, 4.2), layout="constrained")
    series = {}
    for bodies, law, dt, change, _ in found:
        name = law.replace("energy_conserving, energy_exponent: 1, stiffness_factor: 0.03", "energy_conserving, p = 1")
        series.setdefault((name, bodies), []).append((float(dt), float(change)))
    colours = {}
    for (name, bodies), points in series.items():
        colour = colours.setdefault(name, f"C{len(colours)}")
        axes.loglog(*zip(*points), "o-" if bodies == "cubes" else "s--", color=colour, ms=4, label=f"{name}, {bodies}")
    axes.loglog([6.25e-6, 1e-4], [2e-7, 2e-7 * 256], "k:", label="second order")
    axes.set(xlabel="time step [s]", ylabel="change of kinetic energy, r.m.s.")
    axes.grid(alpha=0.3, which="both")
    axes.legend(fontsize=7)
    STUDY.save(figure, "energy.png")


def deviation(line):
    if line["expected"] == 0:
        return f"{line['got']:.1g}"
    return f"{line['got'] / line['expected'] - 1:+.1e}"


def impact_table(lines):
    rows = []
    for line in sorted(select(lines, "table"), key=lambda x: int(x["test"])):
        expected, got = (f"{line[key]:.5g}" for key in ("expected", "got"))
        rows.append([line["test"], line["case"], line["quantity"], f"{expected} ({line['from']})", got, deviation(line)])
    return table(["test", "case", "quantity", "expected", "scree", "deviation"], rows)


def drop_table(lines):
    """The first three bounces and the last one of each restitution."""
    rows, drops = [], select(lines, "drop")
    last = {line["e"]: line["bounce"] for line in drops}
    for line in drops:
        if line["bounce"] in (1, 2, 3, last[line["e"]]):
            expected = 0.1 * line["e"] ** (2 * line["bounce"])
            rows.append([line["e"], line["bounce"], f"{expected:.5g}", f"{line['height']:.5g}",
                         f"{line['height'] / expected - 1:+.1e}"])
    return table(["e", "bounce", "e^(2k) h [m]", "scree [m]", "deviation"], rows)


def experiment_table(lines):
    rows = []
    for angle, expected in EXPERIMENT:
        (line,) = [x for x in select(lines, "test_4", case="Al oxide") if x["x"] == angle]
        got = line["v_t_after"] / line["v_t"]
        rows.append([f"{angle}°", expected, f"{got:.3f}", f"{got / expected - 1:+.1%}"])
    return table(["angle", "experiment", "scree", "deviation"], rows)


def make_page(results):
    lines = results["lines"]
    plot_force(lines)
    plot_test_4(lines)
    plot_tests_5_and_6(lines)
    plot_drops(lines)
    plot_energy(results["energy"])
    return {"impacts": impact_table(lines), "drops": drop_table(lines), "experiment": experiment_table(lines)}


if __name__ == "__main__":
    STUDY.main(compute, make_page)
