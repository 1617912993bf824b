#!/usr/bin/env python3
"""Flow over time: six moments side by side, from one camera that shows the whole apparatus.

    tools/flow.py RUN [-o PICTURE.png]

Moments run from the last frame before the first wall moves, which ends the filling (from the first frame if none
moves), until the particles rest; they are placed half by time, half by the distance the particles have gone.
"""
import argparse

import numpy as np

import pile
from pile import plt
from run_folder import Run

NUM_MOMENTS, HEIGHT = 6, 800


def first_motion(walls):
    """Index of the last frame before a wall moves or goes; 0 if none ever does."""
    first = walls.read(0)["points"]
    for k in range(1, len(walls.times)):
        points = walls.read(k)["points"]
        if points.shape != first.shape or not np.array_equal(points, first):
            return k - 1
    return 0


def distances_gone(particles):
    """Median way of the points until each frame (num_frames)."""
    gone, before = [0.0], particles.read(0)["points"]
    for k in range(1, len(particles.times)):
        points = particles.read(k)["points"]
        gone.append(gone[-1] + float(np.median(np.linalg.norm(points - before, axis=1))))
        before = points
    return np.array(gone)


def choose_moments(times, gone, first):
    """Indices of NUM_MOMENTS frames from `first` on, ascending, all different; all frames if there are no more."""
    times, gone = times[first:] - times[first], gone[first:] - gone[first]
    if len(times) <= NUM_MOMENTS:
        return first + np.arange(len(times))
    last = int(np.argmax(gone >= 0.999 * gone[-1])) if gone[-1] > 0 else len(times) - 1
    last = max(last, NUM_MOMENTS - 1)
    progress = 0.5 * times[: last + 1] / times[last] + 0.5 * gone[: last + 1] / max(gone[last], 1e-300)
    chosen = [int(np.argmin(np.abs(progress - each))) for each in np.linspace(0, progress[-1], NUM_MOMENTS)]
    for k in range(1, NUM_MOMENTS):
        chosen[k] = max(chosen[k], chosen[k - 1] + 1)
    for k in range(NUM_MOMENTS):
        chosen[k] = min(chosen[k], last - (NUM_MOMENTS - 1 - k))
    return first + np.array(chosen)


def save_flow(run, path):
    pile.load(run, 0)
    particles, walls = run.particles(), run.surfaces("walls")
    first = min(first_motion(walls), len(particles.times) - 1) if walls and len(walls.times) else 0
    chosen = choose_moments(particles.times, distances_gone(particles), first)
    frames = [pile.load(run, int(k)) for k in chosen]
    clouds = [pile.without_strays(frame) if wall is None else np.concatenate([frame["points"], wall["points"]])
              for frame, wall in frames]
    points, down = np.concatenate(clouds).astype(float), pile.gravity(run)
    up = pile.unit(-down) if np.any(down) else np.array([0.0, 0.0, 1.0])
    front = pile.front_direction(points, up)
    axes_of_camera = pile.camera_axes(front, up, 8)
    extent = np.ptp(points @ axes_of_camera.T, axis=0)
    size = (int(np.clip(HEIGHT * extent[0] / max(extent[1], 1e-12), 300, 1000)), HEIGHT)
    view = pile.fit_view(points, (front, axes_of_camera), size[0] / size[1], 1.03)
    gap, top = 24, 64
    whole = (len(frames) * (size[0] + gap) + gap, HEIGHT + top + gap)
    figure = plt.figure(figsize=(whole[0] / 100, whole[1] / 100), dpi=100)
    for k, (frame, wall) in enumerate(frames):
        left = (gap + k * (size[0] + gap)) / whole[0]
        axes = figure.add_axes([left, gap / whole[1], size[0] / whole[0], HEIGHT / whole[1]])
        axes.imshow(pile.render(frame, wall, view, size), interpolation="nearest", aspect="auto")
        axes.set_title(f"{particles.times[chosen[k]]:.3g} s", fontsize=22, pad=10)
        axes.set_axis_off()
        if k == 0:
            pile.add_scale_bar(axes, view, size)
    figure.savefig(path)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("run", help="folder of the run")
    parser.add_argument("-o", "--output", help="the picture; default: RUN/pictures/strip.png")
    arguments = parser.parse_args()
    run = Run(arguments.run)
    path = arguments.output or run.pictures() / "strip.png"
    save_flow(run, path)
    print(path)


if __name__ == "__main__":
    main()
