"""A sphere as a clump of many spheres, beside polyhedra of it: force and rebound over their number; makes README.md.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment takes a quarter of the orientations.
"""

import math
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import QUICK, Study, plt, table, write_scene  # noqa: E402
from run_folder import Run  # noqa: E402

STUDY = Study(__file__)
ORIENTATIONS = 25 if QUICK else 100
RADIUS, MODULUS = 0.01, 1e8 / (2 * (1 - 0.25**2))
DEPTHS = [0.002, 0.005, 0.01, 0.02, 0.03]
CLUMPS = [8, 16, 32, 64, 128, 256]
MESHES = [20, 80, 320, 640, 1280, 2560, 5120]
COARSE = [20, 80]  # corners reach out so far that they would start deeper in the plate than scree accepts: not pressed
SPEED, RESTITUTION = 0.05, 0.5


def clump(num):
    """Spheres of half the radius that touch the sphere from inside, on a spiral from pole to pole."""
    spheres = []
    for k in range(num):
        z = 1 - (2 * k + 1) / num
        r, angle = math.sqrt(1 - z * z), math.pi * (3 - math.sqrt(5)) * k
        spheres.append({"position": [RADIUS / 2 * c for c in (r * math.cos(angle), r * math.sin(angle), z)],
                        "radius": RADIUS / 2})
    return {"source": "clump", "spheres": spheres}


def mesh(num):
    return {"source": "sphere", "size": 2 * RADIUS, "triangles": num}


def orientations():
    q = np.random.default_rng(1).normal(size=(ORIENTATIONS, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def scene(shape, heights, velocity, law, time):
    """Bodies in all orientations over one plate, once for every height of the centre."""
    bodies = []
    for n, height in enumerate(heights):
        for k, q in enumerate(orientations()):
            bodies.append({"position": [0.03 * (k - ORIENTATIONS / 2), 0.03 * (n - len(heights) / 2), height],
                           "orientation": [round(float(c), 9) for c in q], "velocity": [0, 0, velocity]})
    material = {"name": "glass", "density": 2500, "youngs_modulus": 1e8, "poisson_ratio": 0.25}
    return {
        "name": "clumps", "gravity": [0, 0, 0], "time": time, "materials": [material],
        "contact_laws": [{"materials": ["glass", "glass"], "friction_coefficient": 0, **law}],
        "shapes": [{"name": "body", **shape}, {"name": "plate", "source": "box", "size": [30, 3, 0.1]}],
        "particles": [{"name": "bodies", "shape": "body", "material": "glass", "bodies": bodies}],
        "walls": [{"name": "plate", "shape": "plate", "material": "glass", "position": [0, 0, -0.05]}],
        "output": {"frames": time["end"], "series": 0, "checkpoint": 1},
    }


def run(name, scene):
    return Run(STUDY.run(write_scene(STUDY.runs / f"{name}.yaml", scene), name).folder)


def press(name, shape):
    """Mean and standard deviation over orientations of the force over Hertz's, for each depth."""
    heights = [RADIUS * (1 - d) for d in DEPTHS]
    frame = run(name, scene(shape, heights, 0, {"damping_ratio": 0}, {"end": 1e-9, "step": 1e-9})).surfaces("contacts").read(0)
    force = np.zeros(len(DEPTHS) * ORIENTATIONS)
    normal = np.abs(np.asarray(frame["normal_force"]).reshape(len(frame["i"]), -1)[:, -1])
    np.add.at(force, np.asarray(frame["i"]), normal)
    hertz = [4 / 3 * MODULUS * math.sqrt(RADIUS) * (d * RADIUS) ** 1.5 for d in DEPTHS]
    shares = force.reshape(len(DEPTHS), ORIENTATIONS) / np.array(hertz)[:, None]
    return {"mean": shares.mean(axis=1).tolist(), "deviation": shares.std(axis=1, ddof=1).tolist()}


def rebound(name, shape):
    """Root of the kinetic energy after an impact over that before: mean and deviation over orientations."""
    law = {"restitution_coefficient": RESTITUTION}
    # a coarse mesh reaches out further than the sphere
    result = run(name, scene(shape, [1.35 * RADIUS], -SPEED, law, {"end": 0.3, "step": 5e-6}))
    energies, before = kinetic_energies(result.folder / "checkpoint.h5", SPEED)
    told = result.summary()["energies"]
    if abs(energies.sum() / (told["kinetic"] + told["rotational"]) - 1) > 1e-9:
        raise SystemExit(f"{name}: the energies of the bodies are not those of summary.json")
    speeds = np.sqrt(energies / before)
    return {"mean": speeds.mean(), "deviation": speeds.std(ddof=1)}


def kinetic_energies(path, speed):
    """Of every body [J], translation and rotation, and what it has with a speed alone."""
    with h5py.File(path) as file:
        part = {name: file["particles"][name][:] for name in ("velocity", "angular_momentum", "orientation", "inertia", "mass")}
    w, axis = part["orientation"][:, :1], part["orientation"][:, 1:]
    # momenta in the body frame, where the moments of inertia are
    once = np.cross(-axis, part["angular_momentum"])
    momenta = part["angular_momentum"] + 2 * (w * once + np.cross(-axis, once))
    moving = part["mass"] * (part["velocity"] ** 2).sum(axis=1)
    return (moving + (momenta**2 / part["inertia"]).sum(axis=1)) / 2, part["mass"] * speed**2 / 2


def compute():
    results = {"orientations": ORIENTATIONS, "depths": DEPTHS, "press": {}, "rebound": {}}
    shapes = {f"clump_{n}": clump(n) for n in CLUMPS} | {f"mesh_{n}": mesh(n) for n in MESHES}
    shapes["sphere"] = {"source": "sphere", "size": 2 * RADIUS}
    for name, shape in shapes.items():
        if name not in [f"mesh_{n}" for n in COARSE]:
            results["press"][name] = press(f"press_{name}", shape)
        results["rebound"][name] = rebound(f"rebound_{name}", shape)
    return results


def expected(num, depth):
    """Of evenly spread spheres of half the radius, over Hertz's force."""
    return num * math.sqrt(0.5) * 0.4 * depth


def draw_force(results):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
    k = DEPTHS.index(0.02)
    error = 1 / math.sqrt(results["orientations"])
    for kind, numbers, style, text in (("clump", CLUMPS, "C3o", "clump of so many spheres"),
                                       ("mesh", MESHES[len(COARSE):], "C0s", "polyhedron of so many triangles")):
        press = [results["press"][f"{kind}_{n}"] for n in numbers]
        axes[0].errorbar(numbers, [p["mean"][k] for p in press], [error * p["deviation"][k] for p in press], fmt=style,
                         label=text)
    axes[0].plot(CLUMPS, [expected(n, 0.02) for n in CLUMPS], "C3-", lw=1, label="evenly spread spheres, closed form")
    axes[0].axhline(1, color="k", lw=0.8)
    axes[0].text(8, 1.05, "Hertz")
    axes[0].set(xscale="log", yscale="log", xlabel="number", ylabel="mean force / Hertz, d = 0.02 R")
    axes[0].legend(frameon=False)
    for n, colour in zip((16, 64, 256), ("C1", "C3", "C5"), strict=True):
        axes[1].plot(DEPTHS, results["press"][f"clump_{n}"]["mean"], "o", color=colour, label=f"clump of {n}")
        axes[1].plot(DEPTHS, [expected(n, d) for d in DEPTHS], "-", color=colour, lw=1)
    for n, colour in zip((320, 5120), ("C9", "C0"), strict=True):
        axes[1].plot(DEPTHS, results["press"][f"mesh_{n}"]["mean"], "s-", color=colour, label=f"{n} triangles")
    axes[1].axhline(1, color="k", lw=0.8)
    axes[1].set(xlabel="depth d/R", ylabel="mean force / Hertz", ylim=(0, 2.5))
    axes[1].legend(frameon=False)
    STUDY.save(figure, "force.png", dpi=110)


def draw_rebound(results):
    figure, axes = plt.subplots(figsize=(6.5, 4.4), layout="constrained")
    for kind, numbers, style, text in (("clump", CLUMPS, "C3o-", "clump of so many spheres"),
                                       ("mesh", MESHES, "C0s-", "polyhedron of so many triangles")):
        found = [results["rebound"][f"{kind}_{n}"] for n in numbers]
        error = 1 / math.sqrt(results["orientations"])
        axes.errorbar(numbers, [r["mean"] for r in found], [error * r["deviation"] for r in found], fmt=style, capsize=2, label=text)
    axes.axhline(results["rebound"]["sphere"]["mean"], color="k", lw=0.8, label="sphere")
    axes.set(xscale="log", xlabel="number", ylabel="speed after / before, mean and its standard error")
    axes.legend(frameon=False)
    STUDY.save(figure, "rebound.png", dpi=110)


def forces_table(results):
    rows = []
    names = {"sphere": "sphere"} | {f"clump_{n}": f"clump of {n}" for n in CLUMPS} | {f"mesh_{n}": f"{n} triangles" for n in MESHES}
    for name, text in names.items():
        press, after = results["press"].get(name), results["rebound"][name]
        cells = zip(press["mean"], press["deviation"], strict=True) if press else []
        rows.append([text, *([f"{m:.3f} ± {s:.3f}" for m, s in cells] or ["refused"] * len(DEPTHS)),
                     f"{after['mean']:.3f} ± {after['deviation']:.3f}"])
    return table(["shape", *(f"d = {d} R" for d in DEPTHS), "rebound"], rows)


def make_page(results):
    draw_force(results)
    draw_rebound(results)
    return {"table": forces_table(results), "orientations": str(results["orientations"])}


if __name__ == "__main__":
    STUDY.main(compute, make_page)
