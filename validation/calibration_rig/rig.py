"""The rig of the study as a scene: that of scenes/calibration_rig_demo.yaml in other proportions."""

import json
import math
import subprocess

QUARTER_TURN = math.pi / 2  # that the doors make
ROCK_SEED = 7
CHUTE = 0.85  # its height: room for rocks of ten triangles before they fall [m]

# name, length and thickness, x and z of the centre [m], turn about y [degrees]; lengths along y are the depth
WALLS = (
    ("bottom_plate", 0.37, 0.01, 0.175, -0.005, 0),
    ("back_wall", 0.35, 0.01, -0.005, 0.165, -90),
    ("end_wall", 0.11, 0.01, 0.355, 0.045, -90),
    ("tilted_plane", 0.22, 0.01, 0.131931, 0.138611, -36),
    ("plane_stop", 0.102687, 0.01, 0.222984, 0.248656, -90),
    ("hopper_left", 0.07, 0.01, 0.0931699, 0.257811, -120),
    ("hopper_right", 0.07, 0.01, 0.18683, 0.257811, -60),
    ("chute_left", CHUTE, 0.01, 0.075, 0.290622 + CHUTE / 2, -90),
    ("chute_right", CHUTE, 0.01, 0.205, 0.290622 + CHUTE / 2, -90),
)
DOORS = (("door_left", 0.1245, 0.109, 8), ("door_right", 0.1555, 0.171, -8))  # name, x, x of the hinge, rad/s
"""Everything above is in the size of the demonstration; the study's rig is smaller."""


def turned(degrees):
    half = math.radians(degrees) / 2
    return [math.cos(half), 0, math.sin(half), 0]


def walls_and_shapes(scale, depth, opening):
    """Plates, doors and the two sides, which are of the material `side`."""
    shapes, walls = [], []

    def add(name, size, position, material="plate", **more):
        shapes.append({"name": name, "source": "box", "size": [size[0], size[1], size[2]]})
        walls.append({"name": name, "shape": name, "material": material, "position": list(position)} | more)

    for name, length, thickness, x, z, turn in WALLS:
        add(name, (scale * length, depth, scale * thickness), (scale * x, depth / 2, scale * z), orientation=turned(turn))
    for name, x, hinge, speed in DOORS:
        motion = {"kind": "rotate", "axis": [0, 1, 0], "centre": [scale * hinge, 0, scale * 0.227], "angular_velocity": speed,
                  "start": opening, "end": opening + QUARTER_TURN / abs(speed), "opens": True}
        add(name, (scale * 0.031, depth, scale * 0.006), (scale * x, depth / 2, scale * 0.227), motion=motion)
    for name, y in (("side_front", -0.005), ("side_rear", depth + 0.005)):
        add(name, (scale * 0.39, 0.01, scale * (CHUTE + 0.31)), (scale * 0.175, y, scale * (CHUTE / 2 + 0.135)), "side")
    return shapes, walls


def rock_scale(program, triangles, seed=ROCK_SEED):
    """Middle size of a rock over that of rock ROCK_SEED of 1000 triangles with the same volume."""
    sizes = []
    for rock in (f"rock:{seed}:{triangles}", f"rock:{ROCK_SEED}:1000"):
        done = subprocess.run([program, "shape", "--generate", rock, "--json"], check=True, capture_output=True, text=True)
        (told,) = json.loads(done.stdout)
        sizes.append(told["middle_size"] / told["volume"] ** (1 / 3))
    return sizes[0] / sizes[1]


def rig(size_scale, proportions, *, triangles=40, seed=ROCK_SEED, friction=0.39, side_friction=0.35, spring=1):
    """The scene. size_scale: rock_scale() of the rock of this seed, so that the volumes do not depend on its shape."""
    count, scale, depth, opening, end = (proportions[name] for name in ("count", "scale", "depth", "opening", "end"))
    shapes, walls = walls_and_shapes(scale, depth, opening)
    sizes = {key: value * size_scale for key, value in (("mean", 0.01), ("deviation", 0.005), ("min", 0.005), ("max", 0.01))}
    return {
        "name": f"calibration rig, {triangles} triangles",
        "time": {"end": end, "step": proportions["step"], "step_fraction": proportions.get("step_fraction", 1)},
        "materials": [
            {"name": "rock", "density": 2700, "youngs_modulus": 2e7, "poisson_ratio": 0.25, "shear_modulus": 2e7},
            {"name": "plate", "density": 7850, "youngs_modulus": 1e8, "poisson_ratio": 0.25, "shear_modulus": 2e7},
            {"name": "side", "density": 7850, "youngs_modulus": 1e8, "poisson_ratio": 0.25, "shear_modulus": 2e7},
        ],
        "contact_laws": [
            {"materials": ["rock", "rock"], "friction_coefficient": friction, "damping_ratio": 0.453619,
             "tangential_spring": spring},
            {"materials": ["rock", "plate"], "friction_coefficient": 0.35, "damping_ratio": 0.382097,
             "tangential_spring": spring},
            {"materials": ["rock", "side"], "friction_coefficient": side_friction, "damping_ratio": 0.382097,
             "tangential_spring": spring},
        ],
        "shapes": [{"name": "rock", "source": "rock", "triangles": triangles, "seed": seed}, *shapes],
        "particles": [{"name": "fill", "shape": "rock", "material": "rock", "count": count, "seed": 1,
                       "size": {"distribution": "normal"} | sizes,
                       "region": {"min": [scale * 0.082, 0.001, scale * 0.292622],
                                  "max": [scale * 0.198, depth - 0.001, scale * (CHUTE + 0.28)]}}],
        "walls": walls,
        "output": {"series": 0.005, "frames": 0.05, "checkpoint": 0.5},
        "repose": {"measure": True, "from": 0, "to": scale * 0.2, "base": 0, "top": scale * 0.075, "bins": 20},
    }
