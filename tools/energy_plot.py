"""Energies over time, and how well they balance.

Above: where the energy has gone, as changes since the start. Middle: energy of motion and energy stored in contacts,
on a logarithmic scale. Below: change of the balance over the largest energy turned over, as energy_error of
summary.json.
"""

import numpy as np

from run_folder import draw_from_command_line

BUDGET = (  # name, column, colour, style
    ("potential", "potential", "#1f4e79", "-"),
    ("kinetic", "kinetic", "#2e8b57", "-"),
    ("dissipated by damping", "damping", "#b3402a", "-"),
    ("dissipated by friction", "friction", "#d98c2b", "-"),
    ("hysteresis", "hysteresis", "#7a5195", "-"),
    ("put in by walls", "input", "#555555", "--"),
)
TURNED_OVER = ("kinetic", "rotational", "elastic_normal", "elastic_tangential", "damping", "friction", "hysteresis")


def checked_series(run):
    """Columns of series.csv, of which those drawn are there."""
    series = run.series()
    missing = [name for name in ("time", "potential", "input", "balance", *TURNED_OVER) if name not in series]
    if missing:
        raise SystemExit(f"series.csv lacks the columns {', '.join(missing)}")
    if len(series["time"]) == 0:
        raise SystemExit("series.csv has no rows; set output.series in the scene")
    return series


def energy_unit(largest):
    """Factor and name of the unit in which `largest` [J] is at least 1."""
    for factor, name in ((1, "J"), (1e3, "mJ"), (1e6, "µJ")):
        if largest * factor >= 1:
            return factor, name
    return 1e9, "nJ"


def balance_error(series):
    """Magnitude of the change of the balance over the largest energy turned over; NaN where it is exactly zero."""
    turned_over = sum(np.abs(series[name]) for name in TURNED_OVER).max()
    error = np.abs(series["balance"] - series["balance"][0]) / (turned_over or 1)
    return np.where(error > 0, error, np.nan)


def draw_budget(axes, series):
    """Changes since the start, linear."""
    changes = [series[column] - series[column][0] for _, column, _, _ in BUDGET]
    factor, name = energy_unit(max(np.abs(change).max() for change in changes))
    for (label, _, colour, style), change in zip(BUDGET, changes, strict=True):
        axes.plot(series["time"], change * factor, color=colour, linestyle=style, label=label)
    axes.axhline(0, color="black", linewidth=0.6)
    axes.set_ylabel(f"change [{name}]")


def draw_stored(axes, series):
    """Motion and springs, logarithmic over at most twelve decades."""
    curves = (
        ("kinetic", series["kinetic"], "#2e8b57"),
        ("rotational", series["rotational"], "#7fbf9b"),
        ("elastic", series["elastic_normal"] + series["elastic_tangential"], "#1f4e79"),
    )
    largest = max(values.max() for _, values, _ in curves)
    for label, values, colour in curves:
        axes.plot(series["time"], np.where(values > 1e-12 * largest, values, np.nan), color=colour, label=label)
    if largest > 0:
        axes.set_yscale("log")
    axes.set_ylabel("energy [J]")


def draw_error(axes, series):
    """Relative error of the balance, logarithmic."""
    error = balance_error(series)
    axes.plot(series["time"], error, color="#b3402a", label="relative error of the balance")
    if np.isfinite(error).any():
        axes.set_yscale("log")
        largest = np.nanmax(error)
        axes.text(0.99, 0.06, f"largest {largest:.1e}", transform=axes.transAxes, ha="right", color="#b3402a")
    axes.set_ylabel("|error| [1]")
    axes.set_xlabel("time [s]")


def draw_energies(run, output):
    """The three panels as a PNG."""
    import matplotlib.pyplot as plt

    series = checked_series(run)
    figure, panels = plt.subplots(
        3, 1, sharex=True, figsize=(10, 9), dpi=150, gridspec_kw={"height_ratios": (3, 2, 1.4)}
    )
    for draw, axes in zip((draw_budget, draw_stored, draw_error), panels, strict=True):
        draw(axes, series)
        axes.grid(color="#e6e6e6", linewidth=0.7)
        axes.set_axisbelow(True)
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    panels[0].set_xlim(series["time"][0], series["time"][-1])
    panels[0].set_title("Energies since the start, and the error of their balance")
    figure.align_ylabels()
    figure.tight_layout()
    figure.savefig(output)
    plt.close(figure)


if __name__ == "__main__":
    draw_from_command_line(draw_energies, "energy.png", __doc__)
