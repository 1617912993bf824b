#!/usr/bin/env python3
"""All pictures of a run into RUN/pictures: pile, strip, energy, contact_forces, height_map if an angle of repose was measured,
and those of fields.py if fields were."""
import argparse

from contact_forces import draw_contact_forces
from energy_plot import draw_energies
from fields import field_pictures
from flow import save_flow
from pile import load, save_pile
from repose_plot import draw_height_map, has_repose
from run_folder import Run


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", help="folder of the run")
    run = Run(parser.parse_args().run)
    load(run, -1)  # refuses a run without frames before anything is written
    pictures = {"pile": save_pile, "strip": save_flow, "energy": draw_energies, "contact_forces": draw_contact_forces}
    if has_repose(run.summary()):
        pictures["height_map"] = draw_height_map
    if (run.folder / "fields.vtkhdf").exists():
        pictures |= field_pictures(run)
    for name, save in pictures.items():
        path = run.pictures() / f"{name}.png"
        save(run, path)
        print(path)


if __name__ == "__main__":
    main()
