"""When can spheres of higher friction stand for polyhedra in a mill? Makes README.md and its pictures.

Usage: python run.py [--keep]
  --keep   pictures and page again from results.json and the runs in runs/mill, without computing anything
QUICK=1 in the environment takes half of the particles. A study that was broken off goes on where it stopped.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import QUICK, ROOT, Study, in_parallel, plt, table  # noqa: E402
from fields import Fields  # noqa: E402
from run_folder import Run  # noqa: E402

STUDY = Study(__file__)
SCENE = ROOT / "scenes" / "tumbling_mill_polyhedra.yaml"
RADIUS, SPEED, FROM = 0.15, 4.0435, 0.98
WALL_FRICTION = 0.31
CUBE, ROUND, SPHERE = "cubes", "icosahedra", "spheres"
SHAPES = {CUBE: [], ROUND: ["shapes.body.source=sphere", "shapes.body.size=0.012", "shapes.body.triangles=20"],
          SPHERE: ["shapes.body.source=sphere", "shapes.body.size=0.012"]}
# beside the lifters there is room for 360 cubes when they are filled in
WIDE = ["particles.bodies.region.min=[-0.149, -0.017, -0.149]", "particles.bodies.region.max=[0.149, 0.017, 0.149]"]
SMOOTH = ["walls.lifters.removed_at=0", "particles.bodies.count=440"]


class Case:
    """Bodies of a shape and friction in one of the drums, from several fillings."""

    def __init__(self, drum, shape, friction, seeds):
        self.drum, self.shape, self.friction, self.seeds = drum, shape, friction, seeds
        self.name = f"{drum}_{shape}_{friction}"
        self.text = f"{shape}, friction {friction}"
        self.settings = SHAPES[shape] + [f"contact_laws.0.friction_coefficient={friction}",
                                         f"contact_laws.1.friction_coefficient={max(friction, WALL_FRICTION)}"]
        if drum == "smooth":
            self.settings += SMOOTH + WIDE * (shape == CUBE)

    def runs(self):
        return [STUDY.runs / f"{self.name}_{seed}" / "only" for seed in self.seeds]


SPHERES = [Case("smooth", SPHERE, friction, (1, 2)) for friction in (0.154, 0.3, 0.45, 0.7, 0.9)]
BODIES = [Case("smooth", ROUND, 0.154, (1, 2)), Case("smooth", CUBE, 0.154, (1, 2))]
CASES = SPHERES + BODIES
SHOWN = [SPHERES[0], SPHERES[2], SPHERES[3], *BODIES]  # in pictures with a panel each
COLOURS = ("C0", "C3", "C4", "C1", "C2")


def compute_one(job):
    case, seed = job
    settings = case.settings + [f"particles.bodies.seed={seed}"] + ["particles.bodies.count=220"] * QUICK
    STUDY.run(SCENE, f"{case.name}_{seed}", settings)


def compute():
    jobs = [(case, seed) for case in CASES for seed in case.seeds]
    in_parallel(compute_one, sorted(jobs, key=lambda job: job[0].shape == SPHERE))
    results = {case.name: [measure(Run(folder)) for folder in case.runs()] for case in CASES}
    return results | {"elsewhere": elsewhere()}


def material(run):
    """Solid fraction of the cells, and the middles of their sides."""
    fields = Fields(run)
    _, fraction, _ = fields.across(1)
    return fraction, [(fields.edges(k)[1:] + fields.edges(k)[:-1]) / 2 for k in (0, 2)]


def centre_of_mass(run):
    fraction, middles = material(run)
    return [float((fraction * part).sum() / fraction.sum()) for part in np.meshgrid(*middles, indexing="ij")]


def packing(fraction):
    return float(np.median(fraction[fraction > 0.5 * fraction.max()]))


def profile(run):
    """The free surface seen along the direction of the centre of mass: place along it and height across it [m].

    The surface is where, from above, the solid fraction first reaches half of the packing. Cells are cut in 10 x 10 and put
    in strips across the surface, of which three side by side are averaged.
    """
    fraction, middles = material(run)
    x, z = centre_of_mass(run)
    lift = np.arctan2(x, -z)
    spacing = middles[0][1] - middles[0][0]
    parts = (np.arange(10) - 4.5) / 10 * spacing
    fine = np.meshgrid(*[(middle[:, None] + parts).ravel() for middle in middles], indexing="ij")
    along = np.cos(lift) * fine[0] + np.sin(lift) * fine[1]
    across = np.cos(lift) * fine[1] - np.sin(lift) * fine[0]
    places = [along.ravel(), across.ravel()]
    edges = [np.linspace(-26, 26, 27) / 40 * RADIUS, np.linspace(-1, 1, 81) * RADIUS]
    solid, _, _ = np.histogram2d(*places, edges, weights=np.kron(fraction, np.ones((10, 10))).ravel())
    cells, _, _ = np.histogram2d(*places, edges)
    solid, cells = (counts[:-2] + counts[1:-1] + counts[2:] for counts in (solid, cells))
    strips, half = solid / np.maximum(cells, 1), packing(fraction) / 2
    w = (edges[1][1:] + edges[1][:-1]) / 2
    top = [np.flatnonzero(strip >= half)[-1] for strip in strips]
    height = [w[k] + (w[k + 1] - w[k]) * (strip[k] - half) / (strip[k] - strip[k + 1])
              for k, strip in zip(top, strips, strict=True)]
    u = (edges[0][1:] + edges[0][:-1]) / 2
    return lift, u[1:-1], np.array(height)


def measure(run):
    fields, series, summary = Fields(run), run.series(), run.summary()
    period = float(fields.averages["period"])
    blocks = np.diff(np.interp(FROM + period * np.arange(9) / 8, series["time"], series["work_drum"])) / (period / 8)
    lift, u, height = profile(run)
    fraction, velocity = fields.across(1)[1:]
    thirds = [np.degrees(lift + np.arctan(np.polyfit(u[part], height[part], 1)[0])) for part in np.split(np.arange(len(u)), 3)]
    power = float(summary["wall_loads"]["drum"]["power_of_periods"])
    return {
        "power": power,
        "power_error": float(blocks.std(ddof=1) / np.sqrt(len(blocks))),
        "scaled_power": power / (summary["mass"] * 9.81 * RADIUS * SPEED),
        "offset": centre_of_mass(run)[0] / RADIUS,
        "lift": float(np.degrees(lift)),
        "slopes": [float(third) for third in thirds],
        "bow": float(thirds[2] - thirds[0]),
        "s_shape": float((thirds[0] + thirds[2]) / 2 - thirds[1]),
        "speed": float(np.nanmax(np.hypot(*velocity)[fraction > 0.1])),
        "packing": packing(fraction),
        "indentation": summary["counters"]["largest_indentation"],
        "energy_error": summary["energy_error"],
        "particles": summary["particles"],
        "mass": summary["mass"],
    }


def share_elsewhere(first, second):
    """Share of the material of one run that is in other cells in another."""
    one, two = (material(run)[0] for run in (first, second))
    return float(np.abs(one / one.sum() - two / two.sum()).sum() / 2)


def elsewhere():
    """Between bodies and spheres of each friction, mean over the fillings; of the same spheres between two fillings."""
    runs = {case.name: [Run(folder) for folder in case.runs()] for case in CASES}
    shares = {}
    for case in SPHERES:
        mine = runs[case.name]
        shares[case.name] = {"other filling": share_elsewhere(*mine[:2])}
        for body in BODIES:
            shares[case.name][body.shape] = float(np.mean([share_elsewhere(a, b) for a in mine for b in runs[body.name]]))
    return shares


def draw_maps():
    figure, axes = plt.subplots(2, len(SHOWN), figsize=(19, 7.6), layout="constrained", sharex=True, sharey=True)
    for column, case in enumerate(SHOWN):
        fields = Fields(Run(case.runs()[0]))
        _, fraction, velocity = fields.across(1)
        x, z = fields.edges(0) * 1e3, fields.edges(2) * 1e3
        porosity = axes[0, column].pcolormesh(x, z, np.where(fraction > 0, 1 - fraction, np.nan).T, cmap="magma_r",
                                              vmin=0.3, vmax=1)
        speed = axes[1, column].pcolormesh(x, z, np.hypot(*velocity).T, cmap="viridis", vmin=0, vmax=1)
        middle = np.meshgrid((x[1:] + x[:-1]) / 2, (z[1:] + z[:-1]) / 2, indexing="ij")
        axes[1, column].quiver(*middle, *velocity, color="white", width=0.003, angles="xy")
        axes[0, column].set_title(case.text)
        for row in (0, 1):
            axes[row, column].add_patch(plt.Circle((0, 0), RADIUS * 1e3, fill=False, linewidth=0.8))
            axes[row, column].set_aspect("equal")
        axes[1, column].set_xlabel("x [mm]")
    for row, (mesh, text) in enumerate(((porosity, "porosity [1]"), (speed, "speed [m/s]"))):
        axes[row, 0].set_ylabel("z [mm]")
        figure.colorbar(mesh, ax=axes[row], label=text)
    STUDY.save(figure, "maps.png", dpi=80)


def draw_surfaces():
    figure, axes = plt.subplots(figsize=(7.5, 4.5), layout="constrained")
    for case, colour in zip(SHOWN, COLOURS, strict=True):
        _, u, height = profile(Run(case.runs()[0]))
        axes.plot(u * 1e3, height * 1e3, marker=".", color=colour, label=case.text)
    axes.set(xlabel="along the surface, uphill [mm]", ylabel="height across it [mm]")
    axes.legend(frameon=False)
    STUDY.save(figure, "surfaces.png", dpi=90)


SHAPE_NUMBERS = (("lift", "angle of the centre of mass [degrees]"), ("s_shape", "S: outer thirds over middle [degrees]"),
                 ("bow", "bow: upper over lower third [degrees]"))


def draw_friction(results):
    figure, axes = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    for one, (key, text) in zip(axes, SHAPE_NUMBERS, strict=True):
        for case in SPHERES:
            values = [run[key] for run in results[case.name]]
            one.plot([case.friction] * len(values), values, "C0o", label="spheres" if case is SPHERES[0] else None)
        for case, colour in zip(BODIES, ("C1", "C2"), strict=True):
            one.axhline(np.mean([run[key] for run in results[case.name]]), color=colour, label=case.text)
        one.set(xlabel="friction of the spheres [1]", ylabel=text)
    axes[0].legend(frameon=False, fontsize=8)
    STUDY.save(figure, "friction.png", dpi=90)


def draw_collisions():
    figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
    for case, colour in zip(SHOWN, COLOURS, strict=True):
        fields = Fields(Run(case.runs()[0]))
        rows = fields.collisions["collisions_of_particles"]
        edges = rows["bin_edges"]
        seconds = float(fields.averages["num_periods"] * fields.averages["period"])
        for part, style in (("normal", "-"), ("tangential", "--")):
            rate = rows[f"count_{part}"][1:-1] / np.log10(edges[1:] / edges[:-1]) / seconds
            axes.step(np.sqrt(edges[1:] * edges[:-1]), np.where(rate > 0, rate, np.nan), where="mid", color=colour,
                      linestyle=style, label=f"{case.text}, {part}")
    axes.set(xscale="log", yscale="log", xlabel="energy lost in a collision [J]", ylabel="collisions per second and decade")
    axes.legend(frameon=False, fontsize=8)
    STUDY.save(figure, "collisions.png", dpi=90)


def mean_of(runs, key, form, factor=1):
    """Mean, and how far the fillings are from it at most where there are several."""
    values = factor * np.array([run[key] for run in runs])
    spread = f" ± {np.ptp(values) / 2:{form}}" if len(values) > 1 else ""
    return f"{values.mean():{form}}{spread}"


def numbers(results):
    rows = [("power of the drum [W]", lambda r: mean_of(r, "power", ".3f")),
            ("its standard error over eighths of the revolution [W]", lambda r: f"{max(run['power_error'] for run in r):.3f}"),
            ("power / (m g R ω)", lambda r: mean_of(r, "scaled_power", ".3f")),
            ("x of the centre of mass / R", lambda r: mean_of(r, "offset", ".3f")),
            ("angle of the centre of mass from the vertical [degrees]", lambda r: mean_of(r, "lift", ".1f")),
            ("slopes of the lower, middle and upper third of the surface [degrees]",
             lambda r: ", ".join(f"{slope:.1f}" for slope in np.mean([run["slopes"] for run in r], axis=0))),
            ("bow: upper less lower third [degrees]", lambda r: mean_of(r, "bow", ".1f")),
            ("S: mean of the outer thirds less middle third [degrees]", lambda r: mean_of(r, "s_shape", ".1f")),
            ("largest mean speed where more than 10 % is solid [m/s]", lambda r: mean_of(r, "speed", ".2f")),
            ("solid fraction of the packing", lambda r: mean_of(r, "packing", ".3f")),
            ("largest indentation [mm]", lambda r: f"{max(run['indentation'] for run in r) * 1e3:.2f}"),
            ("error of the energy balance", lambda r: f"{max((run['energy_error'] for run in r), key=abs):.1e}")]
    return table(["", *(case.text for case in CASES)],
                 [[text, *(show(results[case.name]) for case in CASES)] for text, show in rows])


def shares(results):
    rows = [("icosahedra", ROUND), ("cubes", CUBE), ("the same spheres from another filling", "other filling")]
    return table(["material in other cells than that of [%]", *(case.text for case in SPHERES)],
                 [[text, *(f"{100 * results['elsewhere'][case.name][key]:.1f}" for case in SPHERES)] for text, key in rows])


def make_page(results):
    draw_maps()
    draw_surfaces()
    draw_friction(results)
    draw_collisions()
    return {"table": numbers(results), "elsewhere": shares(results)}


if __name__ == "__main__":
    STUDY.main(compute, make_page)
