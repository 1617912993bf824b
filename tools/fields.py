#!/usr/bin/env python3
"""Pictures of the averages of a run into RUN/pictures: porosity, velocity, power, collisions.

Fields are means over whole periods, cut or averaged across one axis (--across, default y: the axis of a mill). Power is
the work of the moving walls between rows of series.csv; under it the torques of those that turn, in the rows.
"""
import argparse

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from run_folder import Run  # noqa: E402


class Fields:
    """fields.vtkhdf: arrays over (x, y, z), each cell once."""

    def __init__(self, run):
        path = run.folder / "fields.vtkhdf"
        if not path.exists():
            raise SystemExit(f"{run.folder} has no fields.vtkhdf: its scene measures no fields, or no period is over")
        with h5py.File(path, "r", locking=False) as file:
            root = file["VTKHDF"]
            self.origin, self.spacing = root.attrs["Origin"], root.attrs["Spacing"]
            self.arrays = {name: np.moveaxis(root["CellData"][name][:], (0, 1, 2), (2, 1, 0)) for name in root["CellData"]}
            self.averages = dict(file["averages"].attrs)
            self.collisions = {
                name: {key: file[name][key][:] for key in file[name]}
                for name in ("collisions_of_particles", "collisions_with_walls")
                if name in file
            }

    def across(self, axis):
        """Solid fraction and the two velocities of the plane, averaged along an axis, and the plane's cells."""
        fraction = self.arrays["solid_fraction"]
        mean = fraction.mean(axis=axis)
        weight = np.where(fraction > 0, fraction, 0)
        plane = [k for k in range(3) if k != axis]
        velocity = []
        for k in plane:
            moved = (np.nan_to_num(self.arrays["velocity"][..., k]) * weight).sum(axis=axis)
            with np.errstate(invalid="ignore"):
                velocity.append(moved / weight.sum(axis=axis))
        return plane, mean, velocity

    def edges(self, axis):
        return self.origin[axis] + self.spacing[axis] * np.arange(self.arrays["solid_fraction"].shape[axis] + 1)

    def title(self, run):
        periods = int(self.averages["num_periods"])
        return f"{run.name}: mean over {periods} period{'s' if periods > 1 else ''} of {self.averages['period']:.3g} s"


def draw_plane(fields, run, axis, path, with_arrows):
    plane, fraction, velocity = fields.across(axis)
    x, z = fields.edges(plane[0]) * 1e3, fields.edges(plane[1]) * 1e3
    speed = np.hypot(*velocity)
    shown = speed if with_arrows else np.where(fraction > 0, 1 - fraction, np.nan)
    figure, axes = plt.subplots(figsize=(8, 6.6), layout="constrained")
    mesh = axes.pcolormesh(x, z, shown.T, cmap="viridis" if with_arrows else "magma_r",
                           vmin=0 if with_arrows else 0.3, vmax=None if with_arrows else 1)
    figure.colorbar(mesh, label="speed of the mean velocity [m/s]" if with_arrows else "porosity [1]")
    if with_arrows:
        step = max(1, max(speed.shape) // 40)
        middle = [(edges[1:] + edges[:-1]) / 2 for edges in (x, z)]
        chosen = (slice(None, None, step), slice(None, None, step))
        grid = np.meshgrid(*middle, indexing="ij")
        axes.quiver(grid[0][chosen], grid[1][chosen], velocity[0][chosen], velocity[1][chosen], color="white",
                    width=0.0022, angles="xy")
    axes.set(xlabel=f"{'xyz'[plane[0]]} [mm]", ylabel=f"{'xyz'[plane[1]]} [mm]", title=fields.title(run), aspect="equal")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def moving_walls(series):
    return [name[len("work_"):] for name in series if name.startswith("work_")]


def draw_power(run, path):
    """Power of the moving walls between rows, and the torques of those that turn."""
    series = run.series()
    walls = moving_walls(series)
    turning = [wall for wall in walls if f"torque_{wall}" in series]
    num = 2 if turning else 1
    figure, panels = plt.subplots(num, 1, figsize=(9, 1 + 3.5 * num), layout="constrained", sharex=True, squeeze=False)
    panels = panels[:, 0]
    time = series["time"]
    middle = (time[1:] + time[:-1]) / 2
    for wall in walls:
        panels[0].plot(middle, np.diff(series[f"work_{wall}"]) / np.diff(time), linewidth=0.9, label=wall)
    if len(walls) > 1:
        total = np.diff(sum(series[f"work_{wall}"] for wall in walls)) / np.diff(time)
        panels[0].plot(middle, total, color="black", linewidth=1.1, label="all")
    for wall in turning:
        panels[1].plot(time, series[f"torque_{wall}"], linewidth=0.9, label=wall)
        panels[1].set(ylabel="torque [N m]")
    for axes in panels:
        axes.axhline(0, color="black", linewidth=0.5)
        axes.legend(frameon=False)
    panels[0].set(ylabel="power [W]", title=f"{run.name}: power of the moving walls")
    panels[-1].set(xlabel="time [s]")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_collisions(fields, run, path):
    """Collisions per second and decade of the energy that they lost."""
    seconds = float(fields.averages["num_periods"] * fields.averages["period"])
    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    for kind, colour in (("collisions_of_particles", "#1f4e79"), ("collisions_with_walls", "#b3402a")):
        rows = fields.collisions[kind]
        edges = rows["bin_edges"]
        width = np.log10(edges[1:] / edges[:-1])
        for part, style in (("normal", "-"), ("tangential", "--")):
            rate = rows[f"count_{part}"][1:-1] / width / seconds
            axes.step(np.sqrt(edges[1:] * edges[:-1]), np.where(rate > 0, rate, np.nan), where="mid", color=colour,
                      linestyle=style, label=f"{kind.replace('_', ' ')}, {part}")
    axes.set(xscale="log", yscale="log", xlabel="energy lost in a collision [J]",
             ylabel="collisions per second and decade", title=fields.title(run))
    axes.legend(frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def field_pictures(run, axis=1):
    """Pictures that the run has numbers for: functions of run and path by name."""
    fields = Fields(run)
    pictures = {
        "porosity": lambda run, path: draw_plane(fields, run, axis, path, with_arrows=False),
        "velocity": lambda run, path: draw_plane(fields, run, axis, path, with_arrows=True),
    }
    if moving_walls(run.series()):
        pictures["power"] = draw_power
    if fields.collisions:
        pictures["collisions"] = lambda run, path: draw_collisions(fields, run, path)
    return pictures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", help="folder of the run")
    parser.add_argument("--across", choices="xyz", default="y", help="axis that fields are averaged along")
    arguments = parser.parse_args()
    run = Run(arguments.run)
    for name, save in field_pictures(run, "xyz".index(arguments.across)).items():
        path = run.pictures() / f"{name}.png"
        save(run, path)
        print(path)


if __name__ == "__main__":
    main()
