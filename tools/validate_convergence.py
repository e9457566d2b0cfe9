#!/usr/bin/python3
"""Thick plate at 575 m/s with ever smaller cells: is the residual velocity one of the model or of the grid?

  validate_convergence.py                     cells of 3, 2 and 1.5 mm, recommended settings, second method
  validate_convergence.py --cells 2 1         these alone are run; the table shows what is there

Particles shrink with the cells (two along each edge of a plate cell). Each run uses all processors and is not made again
while scene and engine stay the same. Writes the part "convergence" of docs/validation.md and docs/data/convergence.csv.
"""

import argparse
import csv
import os

from plot_common import Refused, run_main
from validation_table import Case, digest, engine_of, markdown_table, replace_block, run_cases

TOP = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
SCENE = os.path.join(TOP, "examples", "scenes", "thick_plate", "scene.toml")
CELLS = [3.0, 2.0, 1.5, 1.0]
RUN_BY_DEFAULT = [3.0, 2.0, 1.5]


def options(cell):
    """Settings of a run: the scene's own at 2 mm, lengths in proportion."""
    ratio = cell / 2.0
    return [f"grid.cell_size={cell:g}", f"bodies.plate.spacing={ratio:g}", f"bodies.rod.spacing.0={0.62 * ratio:g}",
            f"bodies.rod.spacing.1={0.62 * ratio:g}", f"bodies.rod.spacing.2={ratio:g}", "output.particle_interval=0",
            "output.checkpoint_steps=0", "numerics.threads=0"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=float, nargs="+", default=RUN_BY_DEFAULT, metavar="MM", help="run these")
    parser.add_argument("--program", default=os.path.join(TOP, "build", "release", "bin", "ogive"))
    parser.add_argument("--tables-only", action="store_true", help="no runs: the table of what is there")
    arguments = parser.parse_args()
    for cell in arguments.cells:
        if cell not in CELLS:
            raise Refused(f"--cells {cell:g}: expected some of " + ", ".join(f"{known:g}" for known in CELLS))

    engine = engine_of(arguments.program)
    identity = {"scene": digest(SCENE, os.path.join(os.path.dirname(SCENE), "rod.stl")), "engine": digest(engine)}
    output = os.path.join(TOP, "out", "validation", "convergence")
    cases = {cell: Case(os.path.join(output, f"{cell:g}"), [word for option in options(cell) for word in ("--set", option)],
                        identity) for cell in CELLS}
    if not arguments.tables_only:
        run_cases([cases[cell] for cell in arguments.cells], arguments.program, engine, SCENE, 1)

    lines, records = [], []
    for cell, case in cases.items():
        summary = (case.outcome() or {}).get("summary")
        if not summary:
            continue
        energy = summary["energy"]
        values = [cell, summary["particles"], summary["results"]["residual_velocity"], 100 * energy["residual_relative"],
                  100 * energy["transfer_dissipation"] / energy["initial_total"], summary["maximum_speed_ever"] / 575.0,
                  1000 * summary["time"], summary["steps"], summary["wall_seconds"]]
        records.append(values)
        lines.append([f"{values[0]:g}", f"{values[1]}", f"{values[2]:.1f}", f"{values[3]:+.2f}", f"{values[4]:.1f}",
                      f"{values[5]:.2f}", f"{values[6]:.0f}", f"{values[7]}", f"{values[8]:.0f}"])
    if not lines:
        raise Refused(f"{output}: no runs of this engine and scene")
    text = markdown_table(["cell mm", "particles", "Vr m/s", "energy residual %", "transfer %", "fastest particle / V0",
                           "time us", "steps", "wall s"], lines)
    print(text)
    replace_block(os.path.join(TOP, "docs", "validation.md"), "convergence", text)
    with open(os.path.join(TOP, "docs", "data", "convergence.csv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["cell_mm", "particles", "residual_velocity", "energy_residual_percent", "transfer_percent",
                         "fastest_over_v0", "time_us", "steps", "wall_seconds"])
        writer.writerows([[f"{value:.6g}" for value in values] for values in records])


if __name__ == "__main__":
    run_main(main)
