"""Where the time of a step goes, and how it grows: makes README.md and its plots.

Usage: python run.py [--keep]
  --keep   plots and page again from results.json, without computing anything
QUICK=1 in the environment takes smaller beds and shorter runs. A study that was broken off goes on where it stopped.
"""

import json
import os
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from study import PROGRAM, QUICK, ROOT, SINGLE_PROGRAM, Study, build, output_of, plt, table  # noqa: E402

STUDY = Study(__file__)
STAGES = ["search", "contacts", "history", "forces", "gather", "work"]
# Bilock (2020): one V100; bytes and seconds of a step
THESIS_MEMORY = {1e6: 4.0e9, 1e7: 20.6e9}
SCENE = "scenes/gravity_packing.yaml"  # from ROOT: results tell their options, and no path of a machine
# a fall of centimetres instead of a metre, so that half of the run is a packing
FALL = ["particles.fall.region.min=[-0.471,-0.471,0.005]", "particles.fall.spacing=1.05",
        f"particles.fall.count={64 if QUICK else 96}", "time.step=2e-5"]
FALL_STEPS = 5000 if QUICK else 20000
SKINS = ["0.02", "0.1", "0.3", "auto"]
TURNS = 1 if QUICK else 3  # of the runs with different skins, and of the rig


def bench(name, *options, program=PROGRAM):
    return json.loads(output_of([program, "bench", name, *options, "--json", "-"], cwd=ROOT,
                                env=dict(os.environ, OMP_WAIT_POLICY="passive")))


def scene(*overrides, program=PROGRAM, parts=30):
    options = ["--scene", SCENE, "--steps", FALL_STEPS, "--parts", parts]
    for override in [*FALL, *overrides]:
        options += ["--set", override]
    return bench("scene", *options, program=program)


def skin_turns():
    """Runs by skin, all skins in each turn."""
    turns = [{skin: scene(f"solver.skin={skin}", parts=1)["cases"][0] for skin in SKINS} for _ in range(TURNS)]
    return {skin: [turn[skin] for turn in turns] for skin in SKINS}


def rig_turns():
    return [bench("rig", "--steps", 2500 if QUICK else 14000, "--particles", 50)["cases"] for _ in range(TURNS)]


def compute():
    build("scree_program", "scree_single_program")
    bed = ["--particles", 1000 if QUICK else 2000, "--repetitions", 3 if QUICK else 4]
    single = dict(program=SINGLE_PROGRAM)
    kept = STUDY.kept
    results = {"quick": QUICK, "packing": kept("packing", lambda: bench("packing", *bed)), "fall": kept("fall", scene)}
    results["machine"] = results["packing"]["machine"]
    results["savings"] = kept("savings", lambda: bench("packing", "--shape", "schoenhardt", "--savings", *bed))
    results["sphere_savings"] = kept("sphere_savings", lambda: bench("spheres", "--savings", *bed))
    many = ["--particles", 20000 if QUICK else 200000, "--repetitions", 3]
    results["mixed_savings"] = kept("mixed_savings", lambda: bench("packing", "--shape", "sphere", "--savings", *many))
    # the two precisions in turn
    pairs = kept("precision", lambda: [(bench("packing", "--shape", shape, *bed), bench("packing", "--shape", shape, *bed, **single))
                                       for shape in ("cube", "schoenhardt", "sphere")])
    results["precision"] = [[double["cases"][0], float_["cases"][0]] for double, float_ in pairs]
    results["skin"] = kept("skin", skin_turns)
    results["rig"] = kept("rig", rig_turns)
    largest = 10000 if QUICK else 1000000
    results["scaling"] = kept("scaling", lambda: bench("scaling", "--particles", largest, "--repetitions", 3, "--steps", 4,
                                                       "--search-every", 4, "--threads", 2))
    # one process for each, for the peak is that of the process
    sizes = [3000, 10000] if QUICK else [10000, 100000, 1000000]
    few = ["--shape", "schoenhardt", "--steps", 2, "--repetitions", 1, "--search-every", 2]
    results["memory"] = kept("memory", lambda: [bench("packing", "--particles", n, *few)["cases"][0] for n in sizes])
    results["memory_single"] = kept("memory_single", lambda: bench("packing", "--particles", sizes[-1], *few, **single)["cases"][0])
    return results


def save(figure, name, results):
    figure.suptitle(results["machine"]["processor"] + ", one thread" * (name != "threads.png"), fontsize=8, color="0.4")
    STUDY.save(figure, name, dpi=110)


def plot_fall(results):
    cases = [c for c in results["fall"]["cases"] if c["mean_contacts"] > 1]
    time = np.array([c["time"] for c in cases])
    steps = np.array([c["steps"] for c in cases])
    contacts = np.array([c["mean_contacts"] for c in cases])
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    for k, stage in enumerate(STAGES):
        spent = 1e6 * np.array([c["stages"][stage]["core_seconds"] for c in cases]) / steps
        axes[0].semilogy(time, np.maximum(spent, 1e-2), color=f"C{k}", label=stage)
        axes[1].loglog(contacts, np.maximum(spent, 1e-2), ".", color=f"C{k}", label=stage)
    line = np.array([contacts.min(), contacts.max()])
    axes[1].loglog(line, 4 * line, "k:", lw=0.8, label="4 µs for each touching pair")
    axes[0].set(xlabel="simulated time [s]", ylabel="time of a step [µs]")
    axes[1].set(xlabel="touching pairs", ylabel="time of a step [µs]")
    for ax in axes:
        ax.grid(alpha=0.3)
        ax.legend(fontsize=7)
    save(figure, "fall.png", results)


def exponent(cases, key):
    if not all(case[key] > 0 for case in cases):
        return float("nan")  # a run so short that nothing touches
    x = np.log([c["triangles"] for c in cases])
    return np.polyfit(x, np.log([case[key] for case in cases]), 1)[0]


def middle_and_spread(values):
    """Median, and largest minus smallest over it."""
    middle = float(np.median(values))
    return middle, f"{100 * (max(values) - min(values)) / middle:.0f} %" if len(values) > 1 else "one run"


def rig_cases(results):
    """Medians over the turns, by number of triangles."""
    cases = []
    for turns in zip(*results["rig"], strict=True):
        whole, spread = middle_and_spread([c["core_seconds"] for c in turns])
        cases.append({"triangles": turns[0]["triangles"], "particles": turns[0]["particles"], "steps": turns[0]["steps"],
                      "contacts": turns[0]["mean_contacts"], "whole": whole, "spread": spread,
                      "in_contacts": float(np.median([c["stages"]["contacts"]["core_seconds"] for c in turns])),
                      "pair": float(np.median([c["core_us_per_contact_step"] for c in turns]))})
    return cases


def rig_table(cases):
    rows = [[c["triangles"], f"{c['contacts']:.1f}", f"{c['whole']:.2f}", c["spread"], f"{c['in_contacts'] / c['whole']:.2f}",
             f"{c['pair']:.2f}"] for c in cases]
    return table(["triangles", "touching pairs, mean", "processor time [s]", "spread", "share of the contacts", "µs for a touching pair and step"], rows)


def plot_rig(results):
    cases = rig_cases(results)
    triangles = np.array([c["triangles"] for c in cases], float)
    whole = np.array([c["whole"] for c in cases])
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    axes[0].loglog(triangles, whole, "o-", label="whole run")
    axes[0].loglog(triangles, [c["in_contacts"] for c in cases], "s-", label="contacts")
    axes[0].loglog(triangles, whole[0] * np.sqrt(triangles / triangles[0]), "k:", lw=0.8, label="square root")
    axes[0].loglog(triangles, whole[0] * triangles / triangles[0], "k--", lw=0.8, label="linear, as the thesis")
    axes[1].loglog(triangles, [c["pair"] for c in cases], "o-")
    axes[0].set(xlabel="triangles of a rock", ylabel="processor time [s]")
    axes[1].set(xlabel="triangles of a rock", ylabel="time for a touching pair and step [µs]")
    axes[0].legend(fontsize=8)
    for ax in axes:
        ax.grid(alpha=0.3, which="both")
    save(figure, "rig.png", results)


def plot_memory(results):
    cases = results["memory"]
    figure, ax = plt.subplots(figsize=(6, 4.2), layout="constrained")
    ax.loglog([c["particles"] for c in cases], [c["bytes"]["peak_resident"] / 1e9 for c in cases], "o-",
              label="scree, double precision, peak of the process")
    ax.loglog(list(THESIS_MEMORY), [b / 1e9 for b in THESIS_MEMORY.values()], "s--", label="Bilock (2020), a V100")
    ax.set(xlabel="particles", ylabel="memory [GB]")
    ax.grid(alpha=0.3, which="both")
    ax.legend(fontsize=8)
    save(figure, "memory.png", results)


def plot_threads(results):
    figure, ax = plt.subplots(figsize=(6, 4.2), layout="constrained")
    for threads, style in ((1, "o-"), (2, "s-")):
        cases = [c for c in results["scaling"]["cases"] if c["threads"] == threads]
        ax.semilogx([c["particles"] for c in cases], [1e6 * c["wall_seconds"] / c["contacts"] for c in cases], style,
                    label=f"{threads} thread{'s' * (threads > 1)}")
    ax.set(xlabel="particles", ylabel="elapsed time for a touching pair and step [µs]", ylim=(0, None))
    ax.grid(alpha=0.3)
    ax.legend()
    save(figure, "threads.png", results)


def packing_table(results):
    cases = results["packing"]["cases"]
    sphere = cases[-1]["core_us_per_contact"]
    rows = [[c["name"], f"{c['pairs_per_particle']:.1f}", f"{c['contacts_per_particle']:.2f}", f"{c['mean_depth']:.1e}",
             f"**{c['core_us_per_contact']:.2f}**",
             *(f"{c['stages'][s]['core_us_per_contact']:.3f}" for s in STAGES), f"{c['rest_us_per_contact']:.3f}",
             f"{c['core_us_per_contact'] / sphere:.1f}", f"{100 * c['spread']:.0f} %"] for c in cases]
    return table(["bed", "candidates", "touching pairs", "depth/size", "µs for each", *STAGES, "rest", "over a sphere",
                  "spread"], rows)


def savings_table(results):
    # of few bodies none change places
    cases = [c for key in ("savings", "sphere_savings") for c in results[key]["cases"] if "mixed" not in c["name"]]
    cases += [c for c in results["mixed_savings"]["cases"] if "mixed" in c["name"]]
    rows = [[c["name"], f"{c['particles']}", f"{c['times_as_long']:.2f}", f"{100 * c['ratio_spread']:.0f} %"]
            for c in cases if " - " in c["name"]]
    return table(["without", "bodies", "times as long", "spread of the ratio"], rows)


def skin_table(results):
    times = {skin: middle_and_spread([c["core_seconds"] for c in turns]) for skin, turns in results["skin"].items()}
    best = min(middle for middle, _ in times.values())
    rows = [[skin, turns[0]["searches"], f"{turns[0]['pairs']}", f"{times[skin][0] / best:.2f}", times[skin][1],
             f"{100 * np.median([c['stages']['search']['core_seconds'] / c['core_seconds'] for c in turns]):.1f} %"]
            for skin, turns in results["skin"].items()]
    return table(["skin", "searches", "candidates at the end", "time over the least", "spread", "share of searches"], rows)


def precision_table(results):
    rows = [[double["name"], f"{double['core_us_per_contact']:.2f}", f"{single['core_us_per_contact']:.2f}",
             f"{single['core_us_per_contact'] / double['core_us_per_contact']:.2f}",
             f"{double['contacts_per_particle']:.2f}, {single['contacts_per_particle']:.2f}",
             f"{single['core_ns_per_particle'] / double['core_ns_per_particle']:.2f}", f"{double['bytes']['per_contact']}, {single['bytes']['per_contact']}"]
            for double, single in results["precision"]]
    return table(["bed", "double [µs]", "single [µs]", "ratio", "touching pairs of a body", "ratio for a body",
                  "bytes of a contact"], rows)


def memory_table(results):
    rows = [[f"{c['particles']:,}".replace(",", " "), f"{c['pairs']:,}".replace(",", " "),
             f"{c['contacts']:,}".replace(",", " "), f"{c['bytes']['peak_resident'] / 1e9:.2f}",
             f"{c['bytes']['peak_resident'] / c['particles']:.0f}"] for c in results["memory"]]
    per = results["memory"][-1]["bytes"]
    return table(["particles", "candidates", "touching pairs", "peak [GB]", "bytes per particle"], rows) + (
        f"\n\nBy the plan {per['per_particle']} bytes for a particle, {per['per_pair']} for a candidate pair, "
        f"{per['per_contact']} for a contact, with history. In single precision {results['memory_single']['particles']} "
        f"bodies with {results['memory_single']['contacts']} touching pairs take "
        f"{results['memory_single']['bytes']['peak_resident'] / 1e9:.2f} GB.")


def threads_text(results):
    cases = results["scaling"]["cases"]
    alone = [c for c in cases if c["threads"] == 1]
    rows = [[a["particles"], *(cell for c in (a, b) for cell in (f"{1e6 * c['wall_seconds'] / c['contacts']:.2f}", f"{100 * c['spread']:.0f} %")),
             f"{a['wall_seconds'] / b['wall_seconds']:.2f}", f"{b['core_us_per_contact'] / a['core_us_per_contact']:.2f}"]
            for a, b in zip(cases[::2], cases[1::2], strict=True)]
    text = table(["particles", "one thread, elapsed µs for a touching pair", "spread", "two threads", "spread", "times as fast",
                  "processor time of two over one"], rows)
    per = [c["core_us_per_contact"] for c in alone]
    return text + (f"\n\nOn one thread the time for a touching pair differs by a factor of {max(per) / min(per):.2f} between the sizes." * (len(alone) > 1))


def make_page(results):
    for plot in (plot_fall, plot_rig, plot_memory, plot_threads):
        plot(results)
    machine = results["machine"]
    rig = rig_cases(results)
    return {
        "machine": f"{machine['processor']} (virtual, {machine['processors']} processors, other work beside it), "
                   f"{machine['compiler']}" + (", QUICK=1: small beds, short runs" if results["quick"] else "") + results.get("remark", ""),
        "packing": packing_table(results),
        "savings": savings_table(results),
        "skin": skin_table(results),
        "precision": precision_table(results),
        "memory": memory_table(results),
        "threads": threads_text(results),
        "rig_whole": f"{exponent(rig, 'whole'):.2f}",
        "rig_pair": f"{exponent(rig, 'pair'):.2f}",
        "bed_particles": str(results["packing"]["cases"][0]["particles"]), "bed_steps": str(results["packing"]["cases"][0]["steps"]),
        "bed_repetitions": str(results["packing"]["cases"][0]["repetitions"]),
        "fall_particles": str(results["fall"]["cases"][0]["particles"]), "fall_steps": str(FALL_STEPS),
        "rig": rig_table(rig), "turns": str(len(results["rig"])),
        "rig_particles": str(rig[0]["particles"]),
        "rig_steps": str(rig[0]["steps"]),
    }


if __name__ == "__main__":
    STUDY.main(compute, make_page)
