#!/usr/bin/env python3
"""The pile: last frame of a run from the front and slightly above, rocks shaded, walls in front left out.

    tools/pile.py RUN [-o PICTURE.png]
"""
import argparse
import dataclasses
import os

import matplotlib
import numpy as np

if "DISPLAY" not in os.environ:
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")  # or VTK warns of a missing screen
import vtk  # noqa: E402  (reads the variable above)
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy  # noqa: E402

from run_folder import Run

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of the back end)

SIZE = (1200, 800)
OVERSAMPLING = 2
ROCKS = ("#c8a877", "#76838f", "#565a5f", "#b3775a", "#d9cdb4", "#8d926f", "#8a5f48", "#a3988c", "#c4b79c", "#67717a")


@dataclasses.dataclass
class View:
    """Camera with parallel rays: axes right, up and towards it (rows), the point it looks at, half the height seen."""

    front: np.ndarray  # horizontal, towards the camera
    axes: np.ndarray
    centre: np.ndarray
    half_height: float


def gravity(run):
    """Gravity of scene.yaml, which has it in a line of its own [m/s^2]; z down if it cannot be read."""
    path = run.folder / "scene.yaml"
    for line in path.read_text().splitlines() if path.exists() else []:
        if line.startswith("gravity:"):
            return np.array([float(part) for part in line[8:].strip(" []").split(",")])
    return np.array([0.0, 0.0, -1.0])


def unit(vector):
    return vector / np.linalg.norm(vector)


def front_direction(points, up):
    """Horizontal direction from the points to the camera: where they are thinnest, -y if all are much the same."""
    candidates = [unit(np.eye(3)[k] - up[k] * up) for k in (1, 0, 2) if abs(up[k]) < 0.75]
    thickness = [np.ptp(points @ candidate) for candidate in candidates]
    best = int(np.argmin(thickness))
    return -candidates[best if thickness[best] < 0.8 * thickness[0] else 0]


def camera_axes(front, up, elevation):
    """Right, up and towards the camera, raised by `elevation` degrees above `front`."""
    angle = np.radians(elevation)
    towards = np.cos(angle) * front + np.sin(angle) * up
    right = unit(np.cross(up, front))
    return np.array([right, np.cross(towards, right), towards])


def fit_view(points, directions, aspect, margin=1.06):
    """The view with these directions (front, axes) that shows all points in a picture of width/height `aspect`."""
    front, axes = directions
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    half = (high - low) / 2
    return View(front, axes, (low + high) / 2 @ axes, margin * max(half[1], half[0] / aspect, 1e-12))


def without_strays(frame):
    """Points but for particles far from nearly all others, which would make a picture of nothing."""
    points = frame["points"].astype(float)
    distance = np.linalg.norm(points - np.median(points, axis=0), axis=1)
    strays = np.unique(frame["particle"][distance > 5 * np.quantile(distance, 0.9)])
    return points[~np.isin(frame["particle"], strays)]


def in_front(walls, particles, towards):
    """Ids of walls that lie wholly between the particles and the camera."""
    depth = particles["points"] @ towards
    limit = np.quantile(depth, 0.98) - 0.02 * np.ptp(depth)
    nearest = {wall: (walls["points"][walls["wall"] == wall] @ towards).min() for wall in np.unique(walls["wall"])}
    return [wall for wall, least in nearest.items() if least >= limit]


def rock_colours(ids):
    """A colour of stone per point from the id of its particle: (n, 3) bytes; neighbours in id differ."""
    palette = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in ROCKS], dtype=float)
    mixed = (ids.astype(np.uint64) + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
    shade = 0.88 + 0.22 * ((mixed >> np.uint64(20)) % np.uint64(1024)).astype(float) / 1023
    chosen = palette[((mixed >> np.uint64(40)) % np.uint64(len(palette))).astype(int)]
    return np.clip(chosen * shade[:, None], 0, 255).astype(np.uint8)


def poly_data(points, triangles):
    data, cells, held = vtk.vtkPolyData(), vtk.vtkCellArray(), vtk.vtkPoints()
    held.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    corners = np.column_stack([np.full(len(triangles), 3), triangles]).astype(np.int64)
    cells.ImportLegacyFormat(numpy_to_vtkIdTypeArray(corners.ravel(), deep=True))
    data.SetPoints(held)
    data.SetPolys(cells)
    return data


def particle_actor(frame):
    data = poly_data(frame["points"], frame["connectivity"].reshape(-1, 3))
    data.GetPointData().SetScalars(numpy_to_vtk(rock_colours(frame["particle"]), deep=True))
    actor = vtk.vtkActor()
    actor.SetMapper(vtk.vtkPolyDataMapper())
    actor.GetMapper().SetInputData(data)
    surface = actor.GetProperty()
    surface.SetInterpolationToFlat()
    surface.SetAmbient(0.22)
    surface.SetDiffuse(0.85)
    surface.SetSpecular(0.06)
    return actor


def wall_actors(walls, hidden):
    """See-through faces, and the edges between faces that are not in one plane."""
    triangles = walls["connectivity"].reshape(-1, 3)
    data = poly_data(walls["points"], triangles[~np.isin(walls["wall"][triangles[:, 0]], hidden)])
    merged, edges = vtk.vtkCleanPolyData(), vtk.vtkFeatureEdges()
    merged.SetInputData(data)
    edges.SetInputConnection(merged.GetOutputPort())
    edges.SetFeatureAngle(30)
    edges.ColoringOff()
    actors = []
    for colour, opacity in (((0.62, 0.68, 0.75), 0.12), ((0.35, 0.38, 0.42), 0.55)):
        actor = vtk.vtkActor()
        actor.SetMapper(vtk.vtkPolyDataMapper())
        actor.GetProperty().SetColor(colour)
        actor.GetProperty().SetOpacity(opacity)
        actor.GetProperty().LightingOff()
        actors.append(actor)
    actors[0].GetMapper().SetInputData(data)
    actors[1].GetMapper().SetInputConnection(edges.GetOutputPort())
    actors[1].GetProperty().SetLineWidth(1.2 * OVERSAMPLING)
    return actors


def add_lights(renderer):
    """A lamp from above on the left, a weak one from the right; both move with the camera."""
    renderer.AutomaticLightCreationOff()
    for place, intensity in (((-0.9, 1.5, 1.4), 0.95), ((1.2, 0.2, 1.0), 0.3)):
        lamp = vtk.vtkLight()
        lamp.SetLightTypeToCameraLight()
        lamp.SetPosition(place)
        lamp.SetIntensity(intensity)
        renderer.AddLight(lamp)


def sequence_of(passes):
    collection, sequence = vtk.vtkRenderPassCollection(), vtk.vtkSequencePass()
    for each in passes:
        collection.AddItem(each)
    sequence.SetPasses(collection)
    camera = vtk.vtkCameraPass()
    camera.SetDelegatePass(sequence)
    return camera


def shade_gaps(renderer, radius):
    """Darkens gaps of about `radius` between particles, before see-through walls are laid over them."""
    shading, peeling = vtk.vtkSSAOPass(), vtk.vtkDepthPeelingPass()
    shading.SetRadius(radius)
    shading.SetBias(0.12 * radius)
    shading.SetKernelSize(96)
    shading.BlurOn()
    shading.SetDelegatePass(sequence_of([vtk.vtkLightsPass(), vtk.vtkOpaquePass()]))
    peeling.SetMaximumNumberOfPeels(12)
    peeling.SetTranslucentPass(vtk.vtkTranslucentPass())
    renderer.SetPass(sequence_of([shading, vtk.vtkLightsPass(), peeling]))


def grab(window, size):
    """The picture (height, width, 3), averaged over the oversampling."""
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    pixels = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars()).astype(float)
    pixels = pixels.reshape(size[1], OVERSAMPLING, size[0], OVERSAMPLING, 3).mean(axis=(1, 3))
    return np.round(pixels[::-1]).astype(np.uint8)


def render(particles, walls, view, size=SIZE):
    """Picture of a frame of particles and one of walls (or None) as (height, width, 3) bytes."""
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(particle_actor(particles))
    if walls is not None and len(walls["connectivity"]):
        for actor in wall_actors(walls, in_front(walls, particles, view.front)):
            renderer.AddActor(actor)
    add_lights(renderer)
    first = particles["points"][particles["particle"] == particles["particle"][0]]
    shade_gaps(renderer, 0.8 * float(np.ptp(first, axis=0).max()))
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(OVERSAMPLING * size[0], OVERSAMPLING * size[1])
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(view.centre)
    camera.SetPosition(view.centre + 10 * view.half_height * view.axes[2])
    camera.SetViewUp(view.axes[1])
    camera.SetParallelScale(view.half_height)
    renderer.ResetCameraClippingRange()
    picture = grab(window, size)
    window.Finalize()
    return picture


def add_scale_bar(axes, view, size=SIZE):
    """A bar of known length in the lower left of axes that show a picture in pixels."""
    pixels_per_metre = size[1] / (2 * view.half_height)
    longest = 0.2 * size[0] / pixels_per_metre
    power = 10.0 ** np.floor(np.log10(longest))
    length = max(m * power for m in (1, 2, 5) if m * power <= longest)
    unit_name, factor = ("m", 1) if length >= 1 else ("mm", 1e3) if length >= 1e-3 else ("µm", 1e6)
    left, y = 0.04 * size[0], 0.95 * size[1]
    right = left + length * pixels_per_metre
    axes.plot([left, right], [y, y], color="black", lw=3, solid_capstyle="butt")
    axes.text((left + right) / 2, y - 0.012 * size[1], f"{length * factor:g} {unit_name}", ha="center", fontsize=14)


def load(run, k):
    """Particles and walls (or None) of frame k; clear words if there are none."""
    particles, walls = run.particles(), run.surfaces("walls")
    if particles is None or len(particles.times) == 0:
        raise SystemExit(f"{run.folder} has no frames: set output.frames in the scene")
    k = range(len(particles.times))[k]
    frame = particles.read(k)
    if len(frame["connectivity"]) == 0:
        raise SystemExit(f"{run.folder} has no particles to show")
    has_walls = walls is not None and len(walls.times) > 0
    return frame, walls.read(min(k, len(walls.times) - 1)) if has_walls else None


def save_pile(run, path):
    """The last frame, framed on the particles, as a PNG of SIZE pixels."""
    particles, walls = load(run, -1)
    up_from = -gravity(run)
    up = unit(up_from) if np.any(up_from) else np.array([0.0, 0.0, 1.0])
    points = particles["points"] if walls is None else np.concatenate([particles["points"], walls["points"]])
    front = front_direction(points.astype(float), up)
    view = fit_view(without_strays(particles), (front, camera_axes(front, up, 18)), SIZE[0] / SIZE[1], 1.12)
    figure = plt.figure(figsize=(SIZE[0] / 100, SIZE[1] / 100), dpi=100)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.imshow(render(particles, walls, view), interpolation="nearest", aspect="auto")
    add_scale_bar(axes, view)
    axes.set_axis_off()
    figure.savefig(path)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("run", help="folder of the run")
    parser.add_argument("-o", "--output", help="the picture; default: RUN/pictures/pile.png")
    arguments = parser.parse_args()
    run = Run(arguments.run)
    path = arguments.output or run.pictures() / "pile.png"
    save_pile(run, path)
    print(path)


if __name__ == "__main__":
    main()
