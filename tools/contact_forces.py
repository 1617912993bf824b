#!/usr/bin/env python3
"""Statistics of the contact forces of a run: contact_forces.csv with a row per frame, and pictures/contact_forces.png of one.

The picture: force chains seen along y, lines from centre to centre as thick as the normal force; how the forces are distributed
about their mean; directions of the contacts in the x-z plane, and the normal force of each. A direction is that from centre to
centre, or from centre to contact point at a wall.
"""
import argparse
import csv

import matplotlib
import numpy as np

from run_folder import Run

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLUMNS = ("time", "contacts", "wall_contacts", "mean_normal_force", "largest_normal_force", "deviation_normal_force",
           "mean_tangential_force", "mobilised_friction", "slipping_share", "anisotropy", "force_anisotropy")


class Contacts:
    """One frame: forces, whether with a wall, directions (unit vectors) and the lines themselves."""

    def __init__(self, surfaces, k, num_particles):
        frame = surfaces.read(k)
        self.time = float(surfaces.times[k])
        self.normal, self.tangential = frame["normal_force"].astype(float), frame["tangential_force"].astype(float)
        self.at_wall, self.slipping = frame["j"] >= num_particles, frame["slipping"] > 0
        offsets = frame["offsets"]
        first, last = frame["connectivity"][offsets[:-1]], frame["connectivity"][offsets[1:] - 1]
        self.ends = np.stack([frame["points"][first], frame["points"][last]], axis=1).astype(float)
        branch = self.ends[:, 1] - self.ends[:, 0]
        self.direction = branch / np.maximum(np.linalg.norm(branch, axis=1, keepdims=True), 1e-300)

    def __len__(self):
        return len(self.normal)

    def row(self):
        """Values of COLUMNS; forces in N."""
        if len(self) == 0:
            return (self.time, 0, 0, *(0.0,) * (len(COLUMNS) - 3))
        mean = self.normal.mean()
        return (self.time, len(self), int(self.at_wall.sum()), mean, self.normal.max(), self.normal.std(),
                self.tangential.mean(), self.tangential.sum() / max(np.abs(self.normal).sum(), 1e-300), self.slipping.mean(),
                anisotropy(self.direction, np.ones(len(self))), anisotropy(self.direction, np.abs(self.normal)))


def anisotropy(directions, weights):
    """Largest less smallest eigenvalue of the fabric tensor <n n>, weighted: 0 for all directions alike, 1 for one alone."""
    tensor = np.einsum("k,ka,kb->ab", weights, directions, directions) / max(weights.sum(), 1e-300)
    return float(np.ptp(np.linalg.eigvalsh(tensor)))


def load(run):
    """Frames of contacts.vtkhdf and the number of particles."""
    surfaces = run.surfaces("contacts")
    if surfaces is None or len(surfaces.times) == 0:
        raise SystemExit(f"{run.folder} has no contacts.vtkhdf with frames: give the scene output.frames above 0")
    particles = run.summary().get("particles")
    if particles is None:
        raise SystemExit(f"{run.folder} has no summary.json: let the run end, or stop it with Ctrl-C")
    return surfaces, particles


def write_table(run):
    surfaces, particles = load(run)
    path = run.folder / "contact_forces.csv"
    temporary = path.with_suffix(".csv.part")
    with open(temporary, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for k in range(len(surfaces.times)):
            writer.writerow([repr(float(value)) if isinstance(value, float | np.floating) else value
                             for value in Contacts(surfaces, k, particles).row()])
    temporary.rename(path)
    return path


def draw_chains(axes, contacts):
    width = 4 * contacts.normal.clip(0) / max(contacts.normal.max(), 1e-300)
    lines = matplotlib.collections.LineCollection(contacts.ends[:, :, [0, 2]] * 1e3, linewidths=width, colors="#7a1f1f",
                                                  capstyle="round")
    axes.add_collection(lines)
    axes.autoscale()
    axes.set(xlabel="x [mm]", ylabel="z [mm]", aspect="equal", title=f"force chains at {contacts.time:.3g} s")


def draw_distribution(axes, contacts):
    for force, name, colour in ((contacts.normal, "normal", "C0"), (contacts.tangential, "tangential", "C1")):
        mean = np.abs(force).mean()
        if mean > 0:
            density, edges = np.histogram(np.abs(force) / mean, bins=np.linspace(0, 8, 33), density=True)
            axes.semilogy((edges[1:] + edges[:-1]) / 2, np.where(density > 0, density, np.nan), f"{colour}o-", ms=3, lw=1,
                          label=f"{name}, mean {mean:.3g} N")
    axes.set(xlabel="force over its mean", ylabel="probability density")
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)


def draw_directions(axes, contacts):
    angle = np.arctan2(contacts.direction[:, 2], contacts.direction[:, 0])
    both = np.concatenate([angle, angle + np.pi]) % (2 * np.pi)  # a contact has no sense
    edges = np.linspace(0, 2 * np.pi, 25)
    number, _ = np.histogram(both, edges)
    force, _ = np.histogram(both, edges, weights=np.tile(np.abs(contacts.normal), 2))
    middle = (edges[1:] + edges[:-1]) / 2
    axes.bar(middle, number / max(number.sum(), 1), width=edges[1], color="C0", alpha=0.4, label="contacts")
    axes.bar(middle, force / max(force.sum(), 1e-300), width=edges[1], fill=False, edgecolor="C3", label="normal force")
    axes.set_yticklabels([])
    axes.set_title("share by direction, x-z plane")
    axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(-0.2, -0.2))


def draw_contact_forces(run, path, time=None):
    """Of the frame next to a time; default: the last one that has contacts."""
    surfaces, particles = load(run)
    frames = range(len(surfaces.times) - 1, -1, -1) if time is None else [surfaces.frame_at(time)]
    for k in frames:
        contacts = Contacts(surfaces, k, particles)
        if len(contacts) > 0:
            break
    figure = plt.figure(figsize=(14, 4.6), layout="constrained")
    if len(contacts) > 0:
        draw_chains(figure.add_subplot(1, 3, 1), contacts)
        draw_distribution(figure.add_subplot(1, 3, 2), contacts)
        draw_directions(figure.add_subplot(1, 3, 3, projection="polar"), contacts)
    else:
        figure.text(0.5, 0.5, "no contacts", ha="center")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", help="folder of the run")
    parser.add_argument("--time", type=float, help="frame of the picture, that next to this time [s]; default: the last with contacts")
    arguments = parser.parse_args()
    run = Run(arguments.run)
    print(write_table(run))
    path = run.pictures() / "contact_forces.png"
    draw_contact_forces(run, path, arguments.time)
    print(path)


if __name__ == "__main__":
    main()
