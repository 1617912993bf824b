"""Height map of the pile with the fitted sigmoid h(x) = c/(1 + exp(a (x - b))) and its steepest slope, at x = b."""

import dataclasses

import numpy as np

from run_folder import draw_from_command_line

MM = 1e3


@dataclasses.dataclass
class Repose:
    """What summary.json tells of the angle of repose; SI units."""

    x: np.ndarray
    heights: np.ndarray
    angle: float
    height: float
    steepness: float
    middle: float
    residual: float

    def edges(self):
        """Ends of the bins (num_bins + 1)."""
        width = self.x[1] - self.x[0] if len(self.x) > 1 else 1e-2
        return np.append(self.x - width / 2, self.x[-1] + width / 2)

    def sigmoid(self, x):
        """The fitted height at x."""
        return self.height / (1 + np.exp(np.clip(self.steepness * (x - self.middle), -700, 700)))

    def tangent(self, x):
        """The straight line of the steepest slope."""
        return self.height / 2 - self.steepness * self.height / 4 * (x - self.middle)


def has_repose(summary):
    """Whether the run measured an angle of repose."""
    return bool(summary.get("height_map_x")) and summary.get("repose_angle_degrees") is not None


def read_repose(summary):
    """The measurement, or an exit that tells that there is none."""
    if not has_repose(summary):
        raise SystemExit("no angle of repose in summary.json; set repose.measure of the scene to true")
    names = ("angle_degrees", "fit_height", "fit_steepness", "fit_middle", "fit_residual")
    try:
        values = [float(summary[f"repose_{name}"]) for name in names]
        return Repose(np.array(summary["height_map_x"]), np.array(summary["height_map_height"]), *values)
    except (KeyError, TypeError, ValueError) as error:
        raise SystemExit(f"the fit of the angle of repose in summary.json is incomplete: {error}") from error


def shown_range(repose):
    """From where to where x is shown: all bins, and the middle of the sigmoid if it is not far away."""
    low, high = repose.edges()[[0, -1]]
    span = high - low
    if low - span < repose.middle < high + span:
        low, high = min(low, repose.middle - 0.12 * span), max(high, repose.middle + 0.12 * span)
    return low, high


def draw_curves(axes, repose):
    """Bins, sigmoid and tangent, in mm."""
    edges = repose.edges()
    axes.stairs(repose.heights * MM, edges * MM, fill=True, color="#d9cdb4", label="_", zorder=1)
    axes.stairs(repose.heights * MM, edges * MM, color="#8a7a5a", linewidth=1.4, label="height in bins", zorder=2)
    low, high = shown_range(repose)
    inside = np.linspace(edges[0], edges[-1], 400)
    axes.plot(inside * MM, repose.sigmoid(inside) * MM, color="#1f4e79", linewidth=2.4, label="fitted sigmoid", zorder=4)
    for end, start in ((low, edges[0]), (edges[-1], high)):
        beyond = np.linspace(end, start, 200)
        axes.plot(beyond * MM, repose.sigmoid(beyond) * MM, color="#1f4e79", linewidth=1.6, linestyle=":", zorder=3)
    x = np.linspace(low, high, 200)
    line = repose.tangent(x)
    seen = (line >= 0) & (line <= max(repose.height, repose.heights.max()) * 1.02)
    axes.plot(x[seen] * MM, line[seen] * MM, color="#b3402a", linewidth=1.8, linestyle="--", zorder=5,
              label=f"steepest slope, {repose.angle:.1f}°")
    if low <= repose.middle <= high:
        axes.plot(repose.middle * MM, repose.height / 2 * MM, "o", color="#b3402a", markersize=7, zorder=6,
                  label=f"middle, x = {repose.middle * MM:.1f} mm")
    return low, high


def draw_height_map(run, output):
    """The height map as a PNG, both axes to the same scale so that angles are true."""
    import matplotlib.pyplot as plt

    repose = read_repose(run.summary())
    figure, axes = plt.subplots(dpi=150)
    low, high = draw_curves(axes, repose)
    x = np.linspace(low, high, 200)
    top = 1.08 * max(repose.heights.max(), repose.sigmoid(x).max(), 1e-9)
    axes.set_xlim(low * MM, high * MM)
    axes.set_ylim(0, top * MM)
    ratio = top / (high - low)
    if 0.15 < ratio < 1.2:
        axes.set_aspect("equal")
    figure.set_size_inches(9, float(np.clip(8 * ratio, 2, 8)) + 1.3)
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("height [mm]")
    axes.set_title(f"Angle of repose {repose.angle:.1f}°, residual of the fit {repose.residual * MM:.2f} mm")
    axes.legend(frameon=False, loc="upper right" if repose.steepness > 0 else "upper left")
    axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(output)
    plt.close(figure)


if __name__ == "__main__":
    draw_from_command_line(draw_height_map, "height_map.png", __doc__)
