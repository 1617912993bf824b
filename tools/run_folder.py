"""Reading a run folder: summary, series, frames. Used by the scripts beside this file."""
import csv
import json
from pathlib import Path

import h5py
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
        """frames, walls or contacts; None if the run has none."""
        path = self.folder / f"{kind}.vtkhdf"
        return Surfaces(path) if path.exists() else None


class Surfaces:
    """A temporal VTKHDF file, frame by frame as numpy arrays."""

    def __init__(self, path):
        self.file = h5py.File(path, "r", locking=False)
        self.root = self.file["VTKHDF"]
        self.steps = self.root["Steps"]
        num_steps = int(self.steps.attrs["NSteps"])
        self.times = self.steps["Values"][:num_steps]
        self.is_lines = self.root["Lines/NumberOfCells"][1] > 0
        self.topology = self.root["Lines" if self.is_lines else "Polygons"]

    def frame_at(self, time):
        """Index of the frame next to a time."""
        return int(np.argmin(np.abs(self.times - time)))

    def read(self, k):
        """Points, cells (lists of ids: offsets and connectivity) and arrays of frame k."""
        column = 1 if self.is_lines else 2
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
