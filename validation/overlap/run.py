"""Errors and times of the overlap against exact arithmetic and CGAL: makes README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment takes a twentieth of the poses.
"""

import json
import platform
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import BUILD, QUICK, Study, build, output_of, plt, table  # noqa: E402

STUDY = Study(__file__)

ROUTES = [  # key of the lines, precision, text, colour, marker
    ("filtered", "double", "scree, filtered signs (default)", "C0", "o"),
    ("convex", "double", "scree, filtered signs, convex path (default for convex bodies)", "C9", "P"),
    ("hierarchy", "double", "scree, hierarchy", "C1", "s"),
    ("filtered", "single", "scree, filtered signs, single precision", "C2", "^"),
    ("hierarchy", "single", "scree, hierarchy, single precision", "C4", "v"),
    ("cgal_inexact", "double", "CGAL corefinement, inexact constructions", "C7", "D"),
    ("cgal_exact", "double", "CGAL corefinement, exact constructions", "C3", "x"),
]


def compute():
    programs = ("overlap_study", "overlap_study_single")
    build(*programs, "test_overlap_certificate")
    counts = (4, 6, 1000) if QUICK else (60, 60, 50000)
    told = "".join(output_of([BUILD / "tests" / "reference" / program, *counts]) for program in programs)
    certificate = output_of([BUILD / "tests" / "test_overlap_certificate"]).splitlines()
    return {"lines": [json.loads(line) for line in told.splitlines() if line.startswith('{"part"')],
            "certificate": [line for line in certificate if line and "checks," not in line],
            "machine": f"{processor()}, {platform.system()}, one thread"}


def quantile(values, q):
    values = sorted(values)
    return values[min(len(values) - 1, int(q * len(values)))]


def error_of(line, route, measure="volume"):
    """Relative error of one line; below one rounding it is drawn as one rounding."""
    value = line.get(f"{route}_{measure}")
    return None if value is None else max(value, 1e-17)


def select(lines, precision, **wanted):
    chosen = [x for x in lines if x["part"] == "size" and x["precision"] == precision]
    return [x for x in chosen if all(x[key] == value for key, value in wanted.items())]


def groups(lines, precision):
    """Lines of one precision by (shape, triangles), smallest first."""
    result = {}
    for line in select(lines, precision):
        result.setdefault((line["triangles"], line["shape"]), []).append(line)
    return dict(sorted(result.items()))


def times_and_errors(lines, route, precision):
    for key, members in groups(lines, precision).items():
        pairs = [(x[f"{route}_s"], error_of(x, route)) for x in members if f"{route}_s" in x and f"{route}_volume" in x]
        if pairs:
            yield key, [p[0] for p in pairs], [p[1] for p in pairs]


def plot_error_over_time(lines):
    figure, axes = plt.subplots(figsize=(8, 5.2), layout="constrained")
    for route, precision, text, colour, marker in ROUTES:
        for i, ((triangles, _), seconds, errors) in enumerate(times_and_errors(lines, route, precision)):
            x = 1e6 * statistics.median(seconds)
            middle = quantile(errors, 0.5)
            axes.plot([x, x], [middle, max(errors)], "-", color=colour, lw=0.8, alpha=0.6)
            axes.plot(x, middle, marker, color=colour, ms=3 + 0.15 * triangles**0.5, label=text if i == 0 else None)
    axes.set(xscale="log", yscale="log", xlabel="time per pair [µs], median", ylabel="relative error of the volume")
    axes.set_title("Median (marks) to worst (lines) error; larger marks: more triangles")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    STUDY.save(figure, "error_over_time.png")


def plot_growth(lines):
    figure, axes = plt.subplots(figsize=(8, 4.8), layout="constrained")
    for route, precision, text, colour, marker in ROUTES:
        for shape, style in (("sphere", "-"), ("rock", "--")):
            points = [
                (key[0], 1e6 * statistics.median(seconds))
                for key, seconds, _ in times_and_errors(lines, route, precision)
                if key[1] == shape
            ]
            if points:
                label = text if shape == "sphere" else None
                axes.plot(*zip(*points), style, marker=marker, color=colour, ms=4, label=label)
    axes.set(xscale="log", yscale="log", xlabel="triangles per body", ylabel="time per pair [µs], median")
    axes.set_title("Two spheres (solid) and two rocks (dashed), depth 1e-4 to 5e-2 of the size")
    axes.grid(alpha=0.3, which="both")
    axes.legend(fontsize=8)
    STUDY.save(figure, "growth.png")


def plot_depth(lines):
    figure, axes = plt.subplots(1, 3, figsize=(11, 4), layout="constrained", sharex=True)
    for ax, measure in zip(axes, ("volume", "area", "centroid")):
        for precision, colour in (("double", "C0"), ("single", "C2")):
            chosen = select(lines, precision)
            points = [(x["depth"], error_of(x, "filtered", measure)) for x in chosen if f"filtered_{measure}" in x]
            ax.plot(*zip(*points), ".", color=colour, ms=3, label=precision)
        ax.set(xscale="log", yscale="log", xlabel="depth / size", title=f"{measure}")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("error: of V by V, of S by |S|, of c by the size")
    axes[0].legend()
    STUDY.save(figure, "error_over_depth.png")


def number(value, digits=2):
    return f"{value:.{digits}g}"


def default_seconds(line):
    return line.get("convex_s", line["filtered_s"])


def time_table(lines):
    rows = []
    single = groups(lines, "single")
    for key, members in groups(lines, "double").items():
        def ratio(route):
            values = [x[f"{route}_s"] / default_seconds(x) for x in members if f"{route}_s" in x]
            return f"{statistics.median(values):.3g}" if values else "-"

        def micro(chosen):
            times = [1e6 * default_seconds(x) for x in chosen or []]
            return f"{statistics.median(times):.3g} ({quantile(times, 0.25):.2g} to {quantile(times, 0.75):.2g})" if times else "-"

        refused = sum("cgal_exact_s" not in x for x in members)
        general = ratio("filtered") if "convex_s" in members[0] else "-"
        rows.append([key[1], key[0], len(members), micro(members), general, ratio("hierarchy"),
                     micro(single.get(key)), ratio("cgal_inexact"), ratio("cgal_exact"), refused])
    header = ["bodies", "triangles each", "poses", "default [µs]", "general / convex path", "hierarchy / default", "single [µs]",
              "CGAL inexact / default", "CGAL exact / default", "refused by CGAL"]
    return table(header, rows)


DEPTHS = [(1e-4, 1e-3), (1e-3, 1e-2), (1e-2, 5e-2)]


def growth_table(lines):
    rows = []
    for shape in ("rock", "sphere"):
        first = {}
        for key, members in groups(lines, "double").items():
            if key[1] != shape:
                continue
            row = [shape, key[0]]
            for low, high in DEPTHS:
                values = [default_seconds(x) for x in members if low <= x["depth"] < high]
                if not values:
                    row.append("-")
                    continue
                middle = statistics.median(values)
                first.setdefault((low, high), middle)
                row.append(f"{1e6 * middle:.3g} ({middle / first[(low, high)]:.2g}; {len(values)})")
            rows.append(row)
    header = ["bodies", "triangles each"] + [f"depth {low:g} to {high:g}" for low, high in DEPTHS]
    return table(header, rows)


def error_table(lines):
    rows = []
    for route, precision, text, _, _ in ROUTES:
        chosen = [x for x in select(lines, precision) if f"{route}_volume" in x]
        if not chosen:
            continue
        row = [text, len(chosen)]
        for measure in ("volume", "area", "centroid"):
            values = [x[f"{route}_{measure}"] for x in chosen if f"{route}_{measure}" in x]
            row += [number(quantile(values, 0.5)), number(quantile(values, 0.99)), number(max(values))] if values else ["-"] * 3
        rows.append(row)
    header = ["", "poses", "V median", "V 99 %", "V worst", "S median", "S 99 %", "S worst", "c median", "c 99 %", "c worst"]
    return table(header, rows)


def kind_table(lines, part):
    rows = []
    for line in (x for x in lines if x["part"] == part and x["precision"] == "double"):
        twin = [x for x in lines if x["part"] == part and x["precision"] == "single" and x["name"] == line["name"]]
        single = f"{twin[0]['units']:.2g}" if twin and twin[0]["poses"] else "-"
        rows.append([line["name"], line["poses"], f"{line['units']:.2g}", f"{line['negative']:.2g}", line["gross"],
                     line["fallbacks"], single])
    header = ["kind", "poses", "worst \\|dV\\|", "most negative V", "gross", "fallbacks", "worst \\|dV\\| in single"]
    return table(header, rows)


def make_page(results):
    lines = results["lines"]
    for plot in (plot_error_over_time, plot_growth, plot_depth):
        plot(lines)
    return {
        "machine": results["machine"],
        "times": time_table(lines),
        "growth": growth_table(lines),
        "errors": error_table(lines),
        "kinds": kind_table(lines, "kind"),
        "lattice": kind_table(lines, "lattice"),
        "certificate": "\n".join(results["certificate"]),
    }


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


if __name__ == "__main__":
    STUDY.main(compute, make_page)
