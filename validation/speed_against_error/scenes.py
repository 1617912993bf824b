"""The three scenes of the study, as dictionaries; YAML reads JSON, so that is how they are written."""

import math
import random
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "validation" / "calibration_rig"))
from rig import ROCK_SEED, rig, rock_scale  # noqa: E402

STONE = {"name": "stone", "density": 2500, "youngs_modulus": 1e7, "poisson_ratio": 0.25}
LAW = {"materials": ["stone", "stone"], "friction_coefficient": 0.5, "restitution_coefficient": 0.5}
RIG = {"count": 45, "scale": 0.75, "depth": 0.026, "opening": 0.3, "end": 0.65, "step": 1e-5}


def random_quaternion(rng):
    parts = [rng.gauss(0, 1) for _ in range(4)]
    length = math.sqrt(sum(part * part for part in parts))
    return [part / length for part in parts]


def rock(maker, triangles, size, seed=3):
    """A rock as a file, so that programs of both precisions have the same one: each would simplify it to another mesh.

    maker: (program, folder of the scene).
    """
    program, folder = maker
    fine = shape(program, "--generate", f"rock:{seed}:1000")
    path = folder / f"rock_{seed}_{triangles}_{size}.obj"
    shape(program, "--generate", f"rock:{seed}:{triangles}", "--volume", f"{fine * size**3!r}", "-o", path)
    return {"name": "rock", "source": "file", "file": path.name}


def shape(program, *arguments):
    """Runs scree shape; returns the volume that it tells."""
    done = subprocess.run([program, "shape", *(str(a) for a in arguments), "--json"], check=True, capture_output=True, text=True)
    return float(re.search(r'"volume": (\S+),', done.stdout)[1])


def collisions(seed, triangles, maker, pairs=100):
    """Pairs of rocks of 0.1 m that meet with 2 m/s, each pair far from the others, without gravity."""
    rng, bodies, side = random.Random(seed), [], math.ceil(math.sqrt(pairs))
    for k in range(pairs):
        x, y = 0.6 * (k % side), 0.6 * (k // side)
        for sign in (-1, 1):
            bodies.append({"position": [x + sign * 0.09, y + rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02)],
                           "velocity": [-sign, 0, 0], "orientation": random_quaternion(rng)})
    return {"name": "collisions", "gravity": [0, 0, 0], "time": {"end": 0.14}, "materials": [STONE], "contact_laws": [LAW],
            "shapes": [rock(maker, triangles, 0.1)],
            "particles": [{"name": "rocks", "shape": "rock", "material": "stone", "bodies": bodies}],
            "output": {"series": 0.05, "frames": 0, "checkpoint": 1}}


def packing(seed, triangles, maker, end=0.95, layers=10):
    """Rocks of 50 mm, four in a layer, that fall into a box of 0.22 m; first impacts at 0.1 s."""
    rng = random.Random(seed)
    bodies = [{"position": [x + rng.uniform(-5e-3, 5e-3), y + rng.uniform(-5e-3, 5e-3), 0.06 + 0.09 * layer],
               "orientation": random_quaternion(rng)}
              for layer in range(layers) for x in (-0.05, 0.05) for y in (-0.05, 0.05)]
    shapes = [rock(maker, triangles, 0.05),
              {"name": "plate", "source": "box", "size": [0.6, 0.6, 0.1]},
              {"name": "along_x", "source": "box", "size": [0.6, 0.1, 1.4]},
              {"name": "along_y", "source": "box", "size": [0.1, 0.6, 1.4]}]
    places = [("plate", (0, 0, -0.05))] + [("along_x", (0, s * 0.16, 0.7)) for s in (-1, 1)]
    places += [("along_y", (s * 0.16, 0, 0.7)) for s in (-1, 1)]
    walls = [{"name": f"wall{k}", "shape": shape, "material": "stone", "position": list(position)}
             for k, (shape, position) in enumerate(places)]
    return {"name": "packing", "time": {"end": end}, "materials": [STONE], "contact_laws": [LAW], "shapes": shapes,
            "particles": [{"name": "rocks", "shape": "rock", "material": "stone", "bodies": bodies}],
            "walls": walls, "output": {"series": end / 40, "frames": 0, "checkpoint": 10 * end}}


def flow(seed, triangles, maker):
    """The start of the flow in a rig like that of the study calibration_rig, with half as many rocks."""
    scene = rig(rock_scale(maker[0], triangles), RIG, triangles=triangles)
    scene["shapes"][0] = rock(maker, triangles, 0.01, ROCK_SEED)
    scene["particles"][0]["seed"] = seed
    return scene | {"output": {"series": 0.005, "frames": 0, "checkpoint": 1}}
