"""Reading a run folder: summary, series, frames. Used by the scripts beside this file."""
import argparse
import csv
import json
from pathlib import Path

import h5py
import matplotlib
import numpy as np


class Run:
    """One folder that `scree run` wrote."""

    def __init__(self, folder):
        self.folder = Path(folder)
        if not (self.folder / "series.csv").exists():
            raise SystemExit(f"{self.folder} is not the folder of a run: it has no series.csv")

    @property
    def name(self):
        return self.summary().get("scene") or self.folder.name

    def summary(self):
        """summary.json; empty if the run has not ended."""
        path = self.folder / "summary.json"
        return json.loads(path.read_text()) if path.exists() else {}

    def series(self):
        """Columns of series.csv by name, without units."""
        with open(self.folder / "series.csv", newline="") as file:
            rows = [row for row in csv.reader(file)]
        names = [name.split(" [")[0] for name in rows[0]]
        whole = [row for row in rows[1:] if len(row) == len(names)]
        table = np.array(whole, dtype=float).reshape(len(whole), len(names))
        return {name: table[:, k] for k, name in enumerate(names)}

    def pictures(self):
        """The folder for pictures, made if missing."""
        path = self.folder / "pictures"
        path.mkdir(exist_ok=True)
        return path

    def surfaces(self, kind="frames"):
        """frames, spheres, walls or contacts; None if the run has none."""
        path = self.folder / f"{kind}.vtkhdf"
        return Surfaces(path) if path.exists() else None

    def particles(self):
        """Polyhedra and spheres together as triangles; None if the run has no frames."""
        files = [surfaces for surfaces in (self.surfaces("frames"), self.surfaces("spheres")) if surfaces is not None]
        return Particles(files) if files else None


def draw_from_command_line(draw, name, text):
    """A program that draws one picture: draw(run, path); `name` in the run's pictures unless -o says otherwise."""
    matplotlib.use("Agg")
    parser = argparse.ArgumentParser(description=text.split("\n")[0])
    parser.add_argument("run", help="folder of the run")
    parser.add_argument("-o", "--output", help=f"the picture; default: RUN/pictures/{name}")
    arguments = parser.parse_args()
    run = Run(arguments.run)
    path = arguments.output or run.pictures() / name
    draw(run, path)
    print(path)


class Surfaces:
    """A temporal VTKHDF file, frame by frame as numpy arrays."""

    def __init__(self, path):
        self.file = h5py.File(path, "r", locking=False)
        self.root = self.file["VTKHDF"]
        self.steps = self.root["Steps"]
        num_steps = int(self.steps.attrs["NSteps"])
        self.times = self.steps["Values"][:num_steps]
        kinds = ("Vertices", "Lines", "Polygons")
        self.column = next((k for k in (0, 1) if self.root[f"{kinds[k]}/NumberOfCells"][1] > 0), 2)
        self.topology = self.root[kinds[self.column]]

    def frame_at(self, time):
        """Index of the frame next to a time."""
        return int(np.argmin(np.abs(self.times - time)))

    def read(self, k):
        """Points, cells (lists of ids: offsets and connectivity) and arrays of frame k."""
        column = self.column
        part = int(self.steps["PartOffsets"][k])
        num = {name: int(self.topology[name][part]) for name in ("NumberOfCells", "NumberOfConnectivityIds")}
        num_points = int(self.root["NumberOfPoints"][part])
        point = int(self.steps["PointOffsets"][k])
        cell = int(self.steps["CellOffsets"][k, column])
        ids = int(self.steps["ConnectivityIdOffsets"][k, column])
        frame = {
            "points": self.root["Points"][point:point + num_points],
            "offsets": self.topology["Offsets"][cell + part:cell + part + num["NumberOfCells"] + 1],
            "connectivity": self.topology["Connectivity"][ids:ids + num["NumberOfConnectivityIds"]],
        }
        for group, count in (("PointData", num_points), ("CellData", num["NumberOfCells"])):
            for name in self.root[group]:
                first = int(self.steps[f"{group}Offsets"][name][k])
                frame[name] = self.root[group][name][first:first + count]
        return frame

    def bounds(self, frames=None):
        """Lower and upper corner of everything in these frames (default: all)."""
        lower, upper = np.full(3, np.inf), np.full(3, -np.inf)
        for k in range(len(self.times)) if frames is None else frames:
            points = self.read(k)["points"]
            if len(points):
                lower, upper = np.minimum(lower, points.min(axis=0)), np.maximum(upper, points.max(axis=0))
        return lower, upper


def ball(rounds):
    """Points and triangles of an icosahedron on the unit sphere, each triangle cut in four `rounds` times."""
    golden = (1 + 5**0.5) / 2
    points = [p for a in (-1, 1) for b in (-golden, golden) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    points = np.array(points) / np.hypot(1, golden)
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    near = (apart > 0) & (apart < 1.1)
    triangles = [(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[i, k]]
    triangles = [t if np.linalg.det(points[list(t)]) > 0 else t[::-1] for t in triangles]
    for _ in range(rounds):
        corners = points[np.array(triangles)]
        middles = [corners[:, a] + corners[:, b] for a, b in ((0, 1), (1, 2), (2, 0))]
        middles = [middle / np.linalg.norm(middle, axis=1, keepdims=True) for middle in middles]
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        d, e, f = middles
        points = np.concatenate([np.stack(t, axis=1) for t in ((a, d, f), (d, b, e), (f, e, c), (d, e, f))]).reshape(-1, 3)
        triangles = np.arange(len(points)).reshape(-1, 3)
    return points, np.array(triangles)


class Particles:
    """Frames of polyhedra and spheres as one; a sphere becomes triangles, the fewer the more spheres there are."""

    def __init__(self, files):
        self.files = files
        self.times = min((each.times for each in files), key=len)

    def read(self, k):
        frames = [self.as_triangles(each.read(k)) if each.column == 0 else each.read(k) for each in self.files]
        shift = np.cumsum([0] + [len(frame["points"]) for frame in frames])
        merged = {name: np.concatenate([frame[name] for frame in frames]) for name in ("points", "particle", "group", "speed")}
        merged["connectivity"] = np.concatenate([frame["connectivity"] + shift[n] for n, frame in enumerate(frames)])
        return merged

    @staticmethod
    def as_triangles(spheres):
        num = len(spheres["points"])
        points, triangles = ball(3 if num < 200 else 2 if num < 5000 else 1 if num < 100000 else 0)
        frame = {name: np.repeat(spheres[name], len(points)) for name in ("particle", "group", "speed")}
        placed = spheres["points"][:, None] + spheres["radius"][:, None, None] * points.astype(np.float32)
        frame["points"] = placed.reshape(-1, 3)
        frame["connectivity"] = (len(points) * np.arange(num)[:, None, None] + triangles).ravel()
        return frame
