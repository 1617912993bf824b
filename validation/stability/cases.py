"""The hard cases of the stability study, as scenes."""

import math

STIFFNESS = 1e7
SLIDING_FRICTION = 0.4


def scene(name, end, shapes, particles, walls=(), gravity=(0, 0, -9.81), modulus=STIFFNESS, law=None, **more):
    """A scene of one material; law: friction 0.5 and restitution 0.5 unless it says otherwise."""
    return {
        "name": name, "gravity": list(gravity), "time": {"end": end},
        "materials": [{"name": "stone", "density": 2500, "youngs_modulus": modulus, "poisson_ratio": 0.25}],
        "contact_laws": [{"materials": ["stone", "stone"], "friction_coefficient": 0.5, "restitution_coefficient": 0.5}
                         | (law or {})],
        "shapes": shapes, "particles": particles, "walls": list(walls),
        "output": {"series": end / 200, "frames": 0, "checkpoint": 0},
    } | more


ELASTIC = {"friction_coefficient": 0, "restitution_coefficient": 1, "tangential_spring": 0}
CONSERVING = ELASTIC | {"model": "energy_conserving"}
CUBE = {"name": "cube", "source": "box", "size": 0.1}
PLATE = {"name": "plate", "source": "box", "size": [1, 1, 0.1]}
ROCK = {"name": "rock", "source": "rock", "size": 0.1, "triangles": 40, "seed": 3}
FLOOR = {"name": "floor", "shape": "plate", "material": "stone", "position": [0, 0, -0.05]}


def bodies(shape, *placed, name="bodies"):
    return {"name": name, "shape": shape, "material": "stone", "bodies": list(placed)}


def turned(axis, degrees):
    """Quaternion about an axis of length 1."""
    half = math.radians(degrees) / 2
    return [math.cos(half), *(math.sin(half) * part for part in axis)]


def at(position, velocity=(0, 0, 0), orientation=(1, 0, 0, 0), spin=(0, 0, 0)):
    return {"position": list(position), "velocity": list(velocity), "orientation": list(orientation),
            "angular_velocity": list(spin)}


def corner():
    """Three plates at right angles whose corner is at the bottom: gravity along the diagonal."""
    half = 0.05
    return [
        {"name": "x", "shape": "plate", "material": "stone", "position": [-half, 0, 0], "orientation": turned((0, 1, 0), 90)},
        {"name": "y", "shape": "plate", "material": "stone", "position": [0, -half, 0], "orientation": turned((1, 0, 0), 90)},
        FLOOR,
    ]


def impact(name, speed, offset, modulus, law):
    """Two rocks that fly into each other; offset of their lines of flight."""
    return scene(name, 0.6 / speed, [ROCK], [bodies("rock", at((-0.1, 0, 0), (speed, 0, 0)), at(
        (0.1, offset, 0.01), (-speed, 0, 0), turned((0.6, 0, 0.8), 50)))], gravity=(0, 0, 0), modulus=modulus, law=law)


def drop(name, shape, height, orientation=(1, 0, 0, 0), end=0.4, **more):
    return scene(name, end, [shape, PLATE], [bodies(shape["name"], at((0, 0, height), orientation=orientation))], [FLOOR],
                 **more)


def linked_rings(name, separate):
    """A ring through a fixed one; gravity lets it slip along as well."""
    ring = {"name": "ring", "source": "turned", "segments": 24, "profile": [
        {"radius": 0.08, "height": -0.01}, {"radius": 0.1, "height": -0.01},
        {"radius": 0.1, "height": 0.01}, {"radius": 0.08, "height": 0.01}]}
    return scene(name, 0.5, [ring], [bodies("ring", at((0.09, 0, 0), orientation=turned((1, 0, 0), 80)))],
                 [{"name": "hook", "shape": "ring", "material": "stone"}], gravity=(-9.81, 0, -1),
                 solver={"separate_patches": separate})


def cases():
    """Name: (what is hard about it, scene)."""
    tilted = turned((0.6, 0.8, 0), 25)
    thin = {"name": "thin", "source": "box", "size": [0.1, 0.1, 0.002]}
    needle = {"name": "needle", "source": "box", "size": [0.1, 0.002, 0.002]}
    small = CUBE | {"name": "small", "size": 1e-3}
    big = CUBE | {"name": "big", "size": 1}
    return {
        "chatter": ("a cube falls flat on a plate", drop("chatter", CUBE, 0.055)),
        "corner_drop": ("a cube falls on a corner, elastic", drop("corner_drop", CUBE, 0.12, turned((0.6, 0.8, 0), 50),
                                                                  law=ELASTIC)),
        "tower": ("eight cubes, one on the other", scene("tower", 0.4, [CUBE, PLATE], [
            bodies("cube", *(at((0, 0, 0.05 + 0.1 * k)) for k in range(8)))], [FLOOR])),
        "wedge": ("a rock falls into a corner of three planes", scene("wedge", 0.5, [ROCK, PLATE], [
            bodies("rock", at((0.1, 0.1, 0.1), orientation=tilted))], corner(), gravity=(-5.66, -5.66, -5.66))),
        "sliding": ("a cube slides to rest on a plate", scene("sliding", 0.45, [CUBE, PLATE], [
            bodies("cube", at((0, 0, 0.05), (1, 0, 0)))], [FLOOR], law={"friction_coefficient": SLIDING_FRICTION})),
        "grazing": ("two rocks that graze, elastic", impact("grazing", 1, 0.09, STIFFNESS, ELASTIC)),
        "deep": ("two rocks, half of the size deep, elastic", impact("deep", 10, 0.02, 3e6, ELASTIC)),
        "deep_conserving": ("the same, energy_conserving", impact("deep_conserving", 10, 0.02, 3e6, CONSERVING)),
        "thin_plate": ("a plate of 1:50 falls on an edge", drop("thin_plate", thin, 0.06, tilted)),
        "needle": ("a needle of 1:50 falls on its tip", drop("needle", needle, 0.06, turned((0.6, 0.8, 0), 65))),
        # the large one is fixed: all energies are those of the small one
        "size_ratio": ("a cube of 1 mm falls on a fixed cube of 1 m", scene("size_ratio", 0.06, [small, big], [
            bodies("small", at((0.1, 0.07, 1.001), orientation=tilted))], [
            {"name": "big", "shape": "big", "material": "stone", "position": [0, 0, 0.5]}])),
        "rings": ("a ring falls into a fixed one that it is linked with", linked_rings("rings", False)),
        "rings_patches": ("the same, patches as separate contacts", linked_rings("rings_patches", True)),
        "soft": ("a cube of 0.3 MPa on its corner", drop("soft", CUBE, 0.3, turned((0.6, 0.8, 0), 50), end=0.6, modulus=3e5)),
        "stiff": ("a cube of 100 GPa on its corner", drop("stiff", CUBE, 0.091, turned((0.6, 0.8, 0), 50), end=0.05,
                                                          modulus=1e11)),
        "spheres": ("a column of true spheres falls", scene("spheres", 0.4, [
            {"name": "ball", "source": "sphere", "size": 0.1}, PLATE], [
            bodies("ball", *(at((0.002 * (k % 2), 0, 0.06 + 0.1001 * k)) for k in range(6)))], [FLOOR])),
    }


def rests():
    """Name: (what rests, scene, name of the wall that it stands on) of a million steps or more each."""
    side, thickness, height = 0.17, 0.05, 1.1
    inner, outer = (width / math.sqrt(math.pi) for width in (side, side + 2 * thickness))  # radii of circles of the same area
    box = {"name": "box", "source": "turned", "segments": 4, "profile": [
        {"radius": inner, "height": 0}, {"radius": outer, "height": 0},
        {"radius": outer, "height": height}, {"radius": inner, "height": height}]}
    reach = side / 2 - 1e-3
    bed = scene("bed", 1, [ROCK | {"size": 0.05}, box, PLATE], [
        {"name": "bodies", "shape": "rock", "material": "stone", "count": 48, "seed": 1,
         "region": {"min": [-reach, -reach, 0.01], "max": [reach, reach, height]}}],
        [FLOOR, {"name": "box", "shape": "box", "material": "stone", "orientation": turned((0, 0, 1), 45)}])
    return {"tower": (*cases()["tower"], "floor"), "wedge": (*cases()["wedge"], "floor"),
            "bed": ("48 rocks in a box", bed, "floor")}
