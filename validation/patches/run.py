"""Merged or separate patches of L-, U- and ring-shaped bodies: force, moment and heaps; makes README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment makes heaps of fewer bodies and seeds. A study that was broken off goes on where it stopped.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import PROGRAM, QUICK, ROOT, Study, output_of, plt, table, write_scene  # noqa: E402
from run_folder import Run  # noqa: E402

STUDY = Study(__file__)
BODIES, SEEDS = (20, 2) if QUICK else (80, 8)
DEPTH = 0.02  # of the lowest point in the plate, of the size
SIZE = 0.05  # of the bodies of a heap [m]
SHAPES = ("l_shape", "u_shape", "ring")
MODES = ("merged", "separate")


def turned(axis, degrees):
    """Quaternion (w, x, y, z)."""
    half = math.radians(degrees) / 2
    return np.array([math.cos(half), *(math.sin(half) * np.array(axis) / np.linalg.norm(axis))])


def times(p, q):
    """Product of quaternions: q first, then p."""
    w = p[0] * q[0] - p[1:] @ q[1:]
    return np.array([w, *(p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:]))])


def matrix(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def model(name):
    """Vertices and centre of mass of a mesh in models/."""
    path = ROOT / "models" / f"{name}.obj"
    vertices = [line.split()[1:4] for line in path.read_text().splitlines() if line.startswith("v ")]
    told = output_of([PROGRAM, "shape", path])
    centre = next(line.split()[1:4] for line in told.splitlines() if line.strip().startswith("centroid"))
    return np.array(vertices, dtype=float), np.array(centre, dtype=float)


def poses():
    """(case, abscissa, pair for scree overlap, centre of mass of the first body)."""
    plate = {"vertices": [[x, y, z] for x in (-3, 3) for y in (-3, 3) for z in (-1, 0)],
             "triangles": [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
                           [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]}
    starts = {"u_shape": turned((1, 0, 0), -90), "l_shape": times(turned((1, 0, 0), 90), turned((0, 0, 1), 225))}
    for name, start in starts.items():
        vertices, centre = model(name)
        for tilt in np.linspace(0, 3, 61):
            q = times(turned((0, 1, 0), tilt), start)
            lowest = (vertices @ matrix(q).T)[:, 2].min()
            position = np.array([0, 0, -lowest - DEPTH])
            body = {"mesh": str(ROOT / "models" / f"{name}.obj"), "position": position.tolist(), "orientation": q.tolist()}
            yield name, tilt, {"a": body, "b": plate}, matrix(q) @ centre + position
    # a ring linked with a fixed one, clear of it at right angles: turned towards its plane it meets it above and below
    ring = str(ROOT / "models" / "ring.obj")
    position = [0.375, 0.0, 0.0]
    for angle in np.linspace(30, 60, 61):
        body = {"mesh": ring, "position": position, "orientation": turned((1, 0, 0), angle).tolist()}
        yield "ring", angle, {"a": body, "b": {"mesh": ring}}, np.array(position)


def wrench(pieces, centre):
    """Elastic force and moment about the centre of mass, c E* = 1, of contacts as hertz_mindlin has them."""
    force, moment = np.zeros(3), np.zeros(3)
    for piece in pieces:
        if piece["normal"] is not None:
            f = -math.sqrt(piece["volume"] * piece["indentation"]) * np.array(piece["normal"])
            force += f
            moment += np.cross(np.array(piece["centroid"]) - centre, f)
    return force, moment


def press():
    """Force, moment and largest indentation of the cases by mode."""
    listed = list(poses())
    batch = STUDY.runs / "poses.txt"
    batch.write_text("".join(json.dumps({"id": str(k)} | pair) + "\n" for k, (_, _, pair, _) in enumerate(listed)))
    told = {}
    for mode, options in zip(MODES, ([], ["--patches"]), strict=True):
        told[mode] = [json.loads(line) for line in output_of([PROGRAM, "overlap", *options, "--batch", batch]).splitlines()]
    results = {}
    for (case, abscissa, _, centre), merged, separate in zip(listed, told["merged"], told["separate"], strict=True):
        row = {"x": abscissa, "patches": len(separate["patches"])}
        for mode, pieces in zip(MODES, ([merged], separate["patches"]), strict=True):
            force, moment = wrench(pieces, centre)
            row[mode] = [force.tolist(), moment.tolist(), max(piece["indentation"] or 0 for piece in pieces)]
        results.setdefault(case, []).append(row)
    return results


def heap_scene(shape):
    """Bodies of 50 mm that fall from a column and make a heap."""
    return {
        "name": f"heap of {shape}", "time": {"end": 1.5},
        "materials": [{"name": "stone", "density": 2500, "youngs_modulus": 1e7, "poisson_ratio": 0.25}],
        "contact_laws": [{"materials": ["stone", "stone"], "friction_coefficient": 0.5, "restitution_coefficient": 0.4}],
        "shapes": [{"name": "body", "source": "file", "file": str(ROOT / "models" / f"{shape}.obj")},
                   {"name": "plate", "source": "box", "size": [4, 4, 0.1]}],
        "particles": [{"name": "bodies", "shape": "body", "material": "stone", "count": BODIES, "seed": 1,
                       "size": {"distribution": "fixed", "mean": SIZE},
                       "region": {"min": [-0.15, -0.15, 0.005], "max": [0.15, 0.15, 2]}}],
        "walls": [{"name": "floor", "shape": "plate", "material": "stone", "position": [0, 0, -0.05]}],
        "output": {"series": 0.01, "frames": 0.5, "checkpoint": 0.5},
    }


def heaps():
    rows = []
    for shape in SHAPES:
        path = write_scene(STUDY.runs / f"{shape}.yaml", heap_scene(shape))
        varied = [(["solver.separate_patches"], ["false", "true"]),
                  (["particles.bodies.seed"], [str(k + 1) for k in range(SEEDS)])]
        ensemble = STUDY.ensemble(path, shape, varied)
        STUDY.expect(ensemble.run())
        rows += [{"shape": shape, "mode": MODES[member.values["solver.separate_patches"] == "true"]} | measure_heap(member)
                 for member in ensemble.members]
    return rows


def measure_heap(member):
    run = Run(member.folder)
    summary, surfaces = member.summary(), run.surfaces()
    points = surfaces.read(len(surfaces.times) - 1)["points"]
    return {
        "height": summary["energies"]["potential"] / (summary["mass"] * 9.81),
        "spread": float(np.sqrt((points[:, :2] ** 2).sum(axis=1).mean())),
        "coordination": summary["counters"]["coordination_number"],
        "deepest": summary["counters"]["largest_indentation"],
        "moving": summary["energies"]["kinetic"] + summary["energies"]["rotational"],
        "balance": abs(summary["energy_error"]), "seconds": summary["processor_seconds"],
        "mass": summary["mass"], "time_step": summary["time_step"], "seed": int(member.values["particles.bodies.seed"]),
    }


def plot_press(results):
    figure, axes = plt.subplots(2, 3, figsize=(12, 6.5), layout="constrained", sharex="col")
    titles = {"u_shape": "U on its legs", "l_shape": "L on the ends of its limbs", "ring": "ring linked with a ring"}
    for column, (case, title) in enumerate(titles.items()):
        rows = results["press"][case]
        x = [row["x"] for row in rows]
        for mode, colour in zip(MODES, ("C0", "C3"), strict=True):
            force = np.array([row[mode][0] for row in rows])
            moment = np.array([row[mode][1] for row in rows])
            across = 1 if case != "ring" else 0
            axes[0, column].plot(x, np.linalg.norm(force, axis=1), colour, label=mode)
            axes[1, column].plot(x, moment[:, across], colour)
        axes[0, column].set_title(title)
        axes[1, column].set_xlabel("tilt [degrees]" if case != "ring" else "angle between the planes [degrees]")
        for ax in axes[:, column]:
            ax.grid(alpha=0.3)
    axes[0, 0].set_ylabel("force over c E* size²")
    axes[1, 0].set_ylabel("moment over c E* size³")
    axes[0, 0].legend()
    STUDY.save(figure, "press.png")


def plot_heaps(results):
    columns = (("height", "mean height [mm]", 1e3), ("spread", "spread [mm]", 1e3), ("coordination", "coordination number", 1))
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
    for ax, (column, label, unit) in zip(axes, columns, strict=True):
        for k, shape in enumerate(SHAPES):
            for m, mode in enumerate(MODES):
                values = [unit * row[column] for row in results["heaps"] if (row["shape"], row["mode"]) == (shape, mode)]
                ax.plot([k + 0.25 * m - 0.125] * len(values), values, f"C{3 * m}.", ms=4, label=mode if k == 0 else None)
                error = np.std(values, ddof=1) / math.sqrt(len(values))
                ax.errorbar(k + 0.25 * m - 0.06, np.mean(values), error, fmt=f"C{3 * m}o", ms=4, capsize=3)
        ax.set_xticks(range(len(SHAPES)), ["L", "U", "ring"])
        ax.set(ylabel=label)
        ax.grid(alpha=0.3)
    axes[0].legend()
    STUDY.save(figure, "heaps.png")


def heaps_table(results):
    lines = []
    for shape in SHAPES:
        medians = {}
        for mode in MODES:
            rows = [row for row in results["heaps"] if (row["shape"], row["mode"]) == (shape, mode)]
            medians[mode] = np.median([row["seconds"] for row in rows])

            def spread(name, unit=1.0, digits=1, rows=rows):
                values = [unit * row[name] for row in rows]
                return f"{np.mean(values):.{digits}f} ± {np.std(values, ddof=1) / math.sqrt(len(values)):.{digits}f}"

            worst = {name: max(row[name] for row in rows) for name in ("deepest", "moving", "balance")}
            worst["moving"] /= 9.81 * SIZE * rows[0]["mass"]
            lines.append([shape, mode, spread("height", 1e3), spread("spread", 1e3), spread("coordination", 1, 2),
                          f"{1e3 * worst['deepest']:.1f}", f"{worst['moving']:.0e}", f"{worst['balance']:.0e}",
                          f"{medians[mode] / medians['merged']:.2f}"])
    return table(["", "patches", "mean height [mm]", "spread [mm]", "coordination number", "deepest [mm]",
                  "kinetic energy left over m g 50 mm", "error of the balance", "time"], lines)


def differences_table(results):
    """Separate over merged, seed by seed: the same places and orientations at the start."""
    columns = ("height", "spread", "coordination")
    lines, all_of_them = [], {column: [] for column in columns}

    def shown(values):
        return f"{np.mean(values):.1f} ± {np.std(values, ddof=1) / math.sqrt(len(values)):.1f} ({np.std(values, ddof=1):.1f})"

    for shape in SHAPES:
        merged, separate = ({row["seed"]: row for row in results["heaps"] if (row["shape"], row["mode"]) == (shape, mode)}
                            for mode in MODES)
        changes = {column: [100 * (separate[seed][column] / merged[seed][column] - 1) for seed in merged] for column in columns}
        lines.append([shape, len(merged), *(shown(changes[column]) for column in columns)])
        for column in columns:
            all_of_them[column] += changes[column]
    lines.append(["all", len(all_of_them["height"]), *(shown(all_of_them[column]) for column in columns)])
    return table(["", "pairs", "mean height [%]", "spread [%]", "coordination number [%]"], lines)


def forces(rows, mode):
    return [float(np.linalg.norm(row[mode][0])) for row in rows]


def ring_texts(rows):
    """Ranges of force, moment and indentation of the linked rings."""
    moment = max(np.linalg.norm(row["separate"][1]) for row in rows)
    texts = {f"{mode}_indentation": f"{max(row[mode][2] for row in rows):.2f}" for mode in MODES}
    return texts | {"separate_moment": f"{moment:.3f}", "merged_least": f"{min(forces(rows, 'merged')):.3f}",
                    "merged_most": f"{max(forces(rows, 'merged')):.3f}", "separate_most": f"{max(forces(rows, 'separate')):.3f}"}


def make_page(results):
    plot_press(results)
    plot_heaps(results)
    minutes = sum(row["seconds"] for row in results["heaps"]) / 60
    steps = [next(row["time_step"] for row in results["heaps"] if row["shape"] == shape) for shape in SHAPES]
    return {"heaps": heaps_table(results), "differences": differences_table(results), "bodies": str(BODIES), "seeds": str(SEEDS),
            "minutes": f"{minutes:.0f}", "steps": ", ".join(f"{step:.2e}" for step in steps)} | ring_texts(results["press"]["ring"])


if __name__ == "__main__":
    STUDY.main(lambda: {"press": press(), "heaps": heaps()}, make_page)
