#!/usr/bin/python3
"""The beam on a rigid cylinder (Lee et al. 2005, case 1) with coarser and finer cells, contact by the gap and by the surface, in plane
strain and in three dimensions, beside the finite elements of beam_reference.py.

  beam_table.py [--program build/release/bin/ogive] [--work DIR] [--only 3d|plane] [--cells 50 25 12.5] [--table-only]

Each run goes to 15 ms. Quantities are those of beam_reference.py: velocity of the centre of mass, force on the half beam per mm of depth
as the mean of 0.5 ms. Writes docs/data/beam.csv and the table between the markers of docs/validation.md; the finite elements'
rows are read from docs/data/beam_reference.csv. Runs in DIR that are finished are not run again.
"""

import csv
import os
import tempfile

import numpy as np

from plot_common import run_main
from validation_table import (NO_FILES, markdown_table, read_rows, read_table, replace_block,
                              run_scene, table_arguments, write_table)

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
DATA = os.path.join(ROOT, "docs", "data", "beam.csv")
REFERENCE = os.path.join(ROOT, "docs", "data", "beam_reference.csv")
PAGE = os.path.join(ROOT, "docs", "validation.md")
WINDOW, END = 0.5, 15.0  # ms
MODELS = {  # settings for a size of cell, and the depth of the model
    "plane strain": lambda cell: ([f"parameters.depth={3 * cell:g}"], 3 * cell),
    "three dimensions": lambda cell: (["parameters.depth=100", "parameters.room=100", "grid.faces.z_max=free"], 100.0),
}


def quantities(directory, depth):
    with open(os.path.join(directory, "history.csv"), encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    time, momentum, velocity = (np.array([float(row[name]) for row in rows])
                                for name in ("time", "beam.momentum_y", "beam.velocity_y"))
    times = np.linspace(0, END, round(END / 0.025) + 1)
    momentum, velocity = np.interp(times, time, momentum), np.interp(times, time, velocity)
    steps = round(WINDOW / 0.025)
    force = (momentum[steps:] - momentum[:-steps]) / WINDOW / depth
    up = int(np.argmax(velocity > 0))
    at_rest = times[up - 1] - velocity[up - 1] * 0.025 / (velocity[up] - velocity[up - 1])
    at = lambda t: velocity[round(t / 0.025)]
    return {"v_2": at(2), "v_4": at(4), "v_8": at(8), "at_rest": at_rest, "v_12": at(12), "v_15": at(15), "force": force.max() / 1e3}


def row_of(program, work, model, detection, cell):
    settings, depth = MODELS[model](cell)
    directory = os.path.join(work, f"{model.split()[0]}-{detection}-{cell:g}")
    summary = run_scene(program, "beam_on_cylinder/scene.toml", directory, NO_FILES + settings + [
        f"parameters.cell={cell:g}", f"contact.detection={detection}", f"stop.time={END:g}", "output.history_interval=0.025"])
    energy = summary["energy"]
    row = {"model": model, "detection": detection, "cell": f"{cell:g}"}
    row |= {name: f"{value:.5g}" for name, value in quantities(directory, depth).items()}
    return row | {"taken": f"{energy['contact_dissipation'] / energy['initial_total']:.4g}", "unaccounted": f"{energy['residual_relative']:.3g}",
                  "seconds": f"{summary['cpu_seconds']['stepping']:.4g}"}


def table(rows):
    names = ("v_2", "v_4", "v_8", "at_rest", "v_12", "v_15", "force")
    lines = [[f"{row['model']}, {row['detection']}", row["cell"], *(f"{float(row[name]):.2f}" for name in names),
              f"{100 * float(row['taken']):.1f}", f"{100 * float(row['unaccounted']):+.4f}", f"{float(row['seconds']):.0f}"] for row in rows]
    lines += [[f"finite elements, penalty {row['penalty']} MPa/mm", row["brick"], *(f"{float(row[name]):.2f}" for name in names), "", "", ""]
              for row in read_rows(REFERENCE)]
    return markdown_table(["model", "cell or brick mm", "m/s at 2 ms", "4 ms", "8 ms", "at rest, ms", "12 ms", "15 ms", "peak force, kN/mm",
                           "taken by contact %", "unaccounted %", "processor time s"], lines)


def main():
    parser = table_arguments(__doc__, os.path.join(ROOT, "build", "release", "bin", "ogive"))
    parser.add_argument("--only", choices=["plane", "3d"])
    parser.add_argument("--cells", type=float, nargs="+", default=[50, 25, 12.5])
    arguments = parser.parse_args()
    rows = read_table(DATA)
    if not arguments.table_only:
        with tempfile.TemporaryDirectory() as temporary:
            work = arguments.work or temporary
            os.makedirs(work, exist_ok=True)
            models = [model for model in MODELS if arguments.only in (None, "plane" if model.startswith("plane") else "3d")]
            for model in models:
                for detection in ("gap", "surface"):
                    for cell in arguments.cells:
                        row = row_of(arguments.program, work, model, detection, cell)
                        same = lambda other: all(other[key] == row[key] for key in ("model", "detection", "cell"))
                        rows = [other for other in rows if not same(other)] + [row]
                        print(*row.values(), sep="\t", flush=True)
        rows.sort(key=lambda row: (row["model"], row["detection"], -float(row["cell"])))
        write_table(DATA, rows)
    replace_block(PAGE, "beam", table(rows))


if __name__ == "__main__":
    run_main(main)
