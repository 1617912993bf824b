#!/usr/bin/env python3
"""Where the particles of each group are over time: counts in zones, mean positions. RUN/counts.csv and a picture.

A zone is a name and conditions on x, y, z [m] that all hold: --zone "up: x > 0, z > 0". --mean NAME follows the mean
position of a group. Positions are those of the frames: centres of spheres, means of the vertices of polyhedra.
"""
import argparse
import csv
import re

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from run_folder import Run  # noqa: E402

CONDITION = re.compile(r"\s*([xyz])\s*([<>])\s*(-?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*$")


def parse_zone(text):
    """Name and list of (axis, sign, value)."""
    name, _, conditions = text.partition(":")
    parsed = [CONDITION.match(part) for part in conditions.split(",")]
    if not name.strip() or not all(parsed):
        raise argparse.ArgumentTypeError(f'"{text}" is no zone; write it like "up: x > 0, z > 0.01"')
    return name.strip(), [("xyz".index(m[1]), 1 if m[2] == ">" else -1, float(m[3])) for m in parsed]


def group_names(run):
    """Names of the particle groups, from scene.yaml as used."""
    names, is_inside = [], False
    for line in (run.folder / "scene.yaml").read_text().splitlines():
        if re.match(r"\w", line):
            is_inside = line.startswith("particles:")
        found = re.match(r"\s*- name: (\S+)", line) if is_inside else None
        if found:
            names.append(found[1])
    return names


def positions(run):
    """Times, and for each the positions and groups of all particles."""
    files = [surfaces for surfaces in (run.surfaces("spheres"), run.surfaces("frames")) if surfaces is not None]
    if not files:
        raise SystemExit(f"{run.folder} has no frames")
    for k, time in enumerate(files[0].times):
        points, groups = [], []
        for file in files:
            frame = file.read(k)
            ids, inverse, number = np.unique(frame["particle"], return_inverse=True, return_counts=True)
            mean = np.zeros((len(ids), 3))
            np.add.at(mean, inverse, frame["points"].astype(float))
            first = np.zeros(len(ids), dtype=int)
            first[inverse] = frame["group"]
            points.append(mean / number[:, None])
            groups.append(first)
        yield float(time), np.concatenate(points), np.concatenate(groups)


def measure(run, zones, means):
    """Columns by name."""
    names = group_names(run)
    columns = {"time [s]": []}
    for time, points, groups in positions(run):
        columns["time [s]"].append(time)
        for zone, conditions in zones:
            is_inside = np.ones(len(points), dtype=bool)
            for axis, sign, value in conditions:
                is_inside &= sign * (points[:, axis] - value) > 0
            for g, name in enumerate(names):
                columns.setdefault(f"{name} in {zone} [1]", []).append(int((is_inside & (groups == g)).sum()))
        for name in means:
            if name not in names:
                raise SystemExit(f"there is no group {name}; there are {', '.join(names)}")
            middle = points[groups == names.index(name)].mean(axis=0)
            for axis in range(3):
                columns.setdefault(f"{'xyz'[axis]} of {name} [m]", []).append(middle[axis])
    return columns


def draw(run, columns, path):
    counted = [name for name in columns if name.endswith("[1]")]
    placed = [name for name in columns if name.endswith("[m]") and name.startswith("z ")]
    panels = [part for part in (counted, placed) if part]
    figure, axes = plt.subplots(len(panels), 1, figsize=(8, 4 * len(panels)), squeeze=False, layout="constrained")
    for panel, part in zip(axes[:, 0], panels, strict=True):
        for name in part:
            panel.plot(columns["time [s]"], columns[name], label=name[:name.rindex(" [")])
        panel.set(xlabel="time [s]", ylabel="particles" if part is counted else "z [m]")
        panel.legend(frameon=False)
    axes[0, 0].set_title(run.name)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", help="folder of the run")
    parser.add_argument("--zone", action="append", default=[], type=parse_zone, help="NAME: CONDITION, CONDITION, ...")
    parser.add_argument("--mean", action="append", default=[], metavar="GROUP", help="mean position of a group")
    arguments = parser.parse_args()
    if not arguments.zone and not arguments.mean:
        parser.error("name a --zone or a --mean")
    run = Run(arguments.run)
    columns = measure(run, arguments.zone, arguments.mean)
    with open(run.folder / "counts.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))
    draw(run, columns, run.pictures() / "counts.png")
    print(run.folder / "counts.csv")
    print(run.pictures() / "counts.png")


if __name__ == "__main__":
    main()
