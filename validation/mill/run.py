"""Can spheres of high friction stand for polyhedra in a mill? Makes README.md and its pictures.

Usage: python run.py [--keep]
  --keep   pictures and page again from results.json and the runs in runs/mill, without computing anything
QUICK=1 in the environment takes a third of the particles. A study that was broken off goes on where it stopped.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import QUICK, ROOT, Study, plt, table  # noqa: E402
from fields import Fields  # noqa: E402
from run_folder import Run  # noqa: E402

STUDY = Study(__file__)
SCENE = ROOT / "scenes" / "tumbling_mill_polyhedra.yaml"
RADIUS, SPEED, FROM = 0.15, 4.0435, 0.98
CASES = [  # name, text, shape, friction of both contact laws (None: the scene's)
    ("sphere_low", "spheres, friction 0.154", "sphere", None),
    ("sphere_high", "spheres, friction 0.45", "sphere", 0.45),
    ("cube", "cubes, friction 0.154", "cube", None),
]


def compute():
    for name, _, shape, friction in CASES:
        settings = [f"particles.bodies.shape={shape}"] + ["particles.bodies.count=150"] * QUICK
        settings += [f"contact_laws.{law}.friction_coefficient={friction}" for law in (0, 1) if friction]
        STUDY.run(SCENE, name, settings)
    results = {name: measure(name) for name, *_ in CASES}
    return results | {"elsewhere": {f"{one} and cube": elsewhere(one, "cube") for one in ("sphere_low", "sphere_high")}}


def run_of(name):
    return Run(STUDY.runs / name / "only")


def surface(fields):
    """x and height of the free surface: the material of each column, put down at the packing of its middle."""
    _, fraction, _ = fields.across(1)
    x = (fields.edges(0)[1:] + fields.edges(0)[:-1]) / 2
    bottom = -np.sqrt(np.maximum(RADIUS**2 - x**2, 0))
    dense = np.median(fraction[fraction > 0.5 * fraction.max()])
    height = bottom + fraction.sum(axis=1) * fields.spacing[2] / dense
    inner = np.abs(x) < 0.75 * RADIUS
    return x[inner], height[inner]


def slope_angle(x, height):
    return float(np.degrees(np.arctan(np.polyfit(x, height, 1)[0])))


def measure(name):
    run = run_of(name)
    fields, series, summary = Fields(run), run.series(), run.summary()
    time, work = series["time"], series["work_drum"]
    period = float(fields.averages["period"])
    edges = FROM + period * np.arange(9) / 8
    blocks = np.diff(np.interp(edges, time, work)) / (period / 8)
    weight = summary["mass"] * 9.81
    x, height = surface(fields)
    low, high = x < 0, x >= 0
    _, fraction, velocity = fields.across(1)
    grid = np.meshgrid(*[(fields.edges(k)[1:] + fields.edges(k)[:-1]) / 2 for k in (0, 2)], indexing="ij")
    centre = [float((fraction * part).sum() / fraction.sum()) for part in grid]
    solid = fraction > 0.1
    return {
        "power": float(summary["wall_loads"]["drum"]["power_of_periods"]),
        "power_error": float(blocks.std(ddof=1) / np.sqrt(len(blocks))),
        "scaled_power": float(summary["wall_loads"]["drum"]["power_of_periods"]) / (weight * RADIUS * SPEED),
        "offset": centre[0] / RADIUS,
        "lift": float(np.degrees(np.arctan2(centre[0], -centre[1]))),
        "slope_low": slope_angle(x[low], height[low]),
        "slope_high": slope_angle(x[high], height[high]),
        "speed": float(np.nanmax(np.hypot(*velocity)[solid])),
        "packing": float(np.median(fraction[fraction > 0.5 * fraction.max()])),
        "indentation": summary["counters"]["largest_indentation"],
        "energy_error": summary["energy_error"],
        "particles": summary["particles"],
        "mass": summary["mass"],
    }


def elsewhere(first, second):
    """Share of the material of one run that is in other cells in another."""
    one, two = (Fields(run_of(name)).across(1)[1] for name in (first, second))
    return float(np.abs(one / one.sum() - two / two.sum()).sum() / 2)


def draw_maps():
    figure, axes = plt.subplots(2, 3, figsize=(13, 8), layout="constrained", sharex=True, sharey=True)
    for column, (name, text, _, _) in enumerate(CASES):
        fields = Fields(run_of(name))
        _, fraction, velocity = fields.across(1)
        x, z = fields.edges(0) * 1e3, fields.edges(2) * 1e3
        porosity = axes[0, column].pcolormesh(x, z, np.where(fraction > 0, 1 - fraction, np.nan).T, cmap="magma_r",
                                              vmin=0.3, vmax=1)
        speed = axes[1, column].pcolormesh(x, z, np.hypot(*velocity).T, cmap="viridis", vmin=0, vmax=1)
        middle = np.meshgrid((x[1:] + x[:-1]) / 2, (z[1:] + z[:-1]) / 2, indexing="ij")
        axes[1, column].quiver(*middle, *velocity, color="white", width=0.003, angles="xy")
        axes[0, column].set_title(text)
        for row in (0, 1):
            axes[row, column].add_patch(plt.Circle((0, 0), RADIUS * 1e3, fill=False, linewidth=0.8))
            axes[row, column].set_aspect("equal")
        axes[1, column].set_xlabel("x [mm]")
    for row, (mesh, text) in enumerate(((porosity, "porosity [1]"), (speed, "speed [m/s]"))):
        axes[row, 0].set_ylabel("z [mm]")
        figure.colorbar(mesh, ax=axes[row], label=text)
    STUDY.save(figure, "maps.png", dpi=90)


def draw_surfaces():
    figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
    for name, text, _, _ in CASES:
        x, height = surface(Fields(run_of(name)))
        axes.plot(x * 1e3, height * 1e3, marker=".", label=text)
    axes.set(xlabel="x [mm]", ylabel="height of the settled material [mm]", aspect="equal")
    axes.legend(frameon=False)
    STUDY.save(figure, "surfaces.png", dpi=90)


def draw_collisions():
    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    for (name, text, _, _), colour in zip(CASES, ("C0", "C1", "C2"), strict=True):
        fields = Fields(run_of(name))
        rows = fields.collisions["collisions_of_particles"]
        edges = rows["bin_edges"]
        seconds = float(fields.averages["num_periods"] * fields.averages["period"])
        for part, style in (("normal", "-"), ("tangential", "--")):
            rate = rows[f"count_{part}"][1:-1] / np.log10(edges[1:] / edges[:-1]) / seconds
            axes.step(np.sqrt(edges[1:] * edges[:-1]), np.where(rate > 0, rate, np.nan), where="mid", color=colour,
                      linestyle=style, label=f"{text}, {part}")
    axes.set(xscale="log", yscale="log", xlabel="energy lost in a collision [J]", ylabel="collisions per second and decade")
    axes.legend(frameon=False, fontsize=8)
    STUDY.save(figure, "collisions.png", dpi=90)


def numbers(results):
    rows = [("power of the drum [W]", lambda r: f"{r['power']:.3f} ± {r['power_error']:.3f}"),
            ("power / (m g R ω)", lambda r: f"{r['scaled_power']:.3f}"),
            ("x of the centre of mass / R", lambda r: f"{r['offset']:.3f}"),
            ("angle of the centre of mass from the vertical [degrees]", lambda r: f"{r['lift']:.1f}"),
            ("slope of the lower half of the surface [degrees]", lambda r: f"{r['slope_low']:.1f}"),
            ("slope of the upper half [degrees]", lambda r: f"{r['slope_high']:.1f}"),
            ("largest mean speed where more than 10 % is solid [m/s]", lambda r: f"{r['speed']:.2f}"),
            ("solid fraction of the packing", lambda r: f"{r['packing']:.3f}"),
            ("largest indentation [mm]", lambda r: f"{r['indentation'] * 1e3:.2f}"),
            ("error of the energy balance", lambda r: f"{r['energy_error']:.1e}")]
    return table(["", *(text for _, text, _, _ in CASES)],
                 [[text, *(show(results[name]) for name, *_ in CASES)] for text, show in rows])


def make_page(results):
    draw_maps()
    draw_surfaces()
    draw_collisions()
    return {
        "table": numbers(results),
        "low": f"{100 * results['elsewhere']['sphere_low and cube']:.1f}",
        "high": f"{100 * results['elsewhere']['sphere_high and cube']:.1f}",
    }


if __name__ == "__main__":
    STUDY.main(compute, make_page)
