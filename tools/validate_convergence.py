#!/usr/bin/python3
"""Thick plate at 575 m/s with ever smaller cells: is the residual velocity one of the model or of the grid?

  validate_convergence.py                     cells of 3, 2 and 1.5 mm, recommended settings, second method
  validate_convergence.py --cells 2 1         these alone are run; the table shows what is there
  validate_convergence.py --contact           rod elastic and rigid, contact by the gap of nodes and by the rod's true surface
  validate_convergence.py --contact --speeds 400 --cells 3

Particles shrink with the cells (two along each edge of a plate cell). Each run uses all processors and is not made again
while scene and engine stay the same. Writes the part "convergence" of docs/validation.md and docs/data/convergence.csv, or
"surface-contact" and docs/data/surface_contact.csv.
"""

import argparse
import csv
import os

from plot_common import Refused, run_main
from validation_table import Case, digest, engine_of, last_run, markdown_table, replace_block, run_cases

TOP = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
SCENE = os.path.join(TOP, "examples", "scenes", "thick_plate", "scene.toml")
CELLS = [4.0, 3.0, 2.0, 1.5, 1.0]
RUN_BY_DEFAULT = [3.0, 2.0, 1.5]
RUN_BY_DEFAULT_FOR_CONTACT = [4.0, 3.0, 2.0]
SPEEDS = [575, 400]
READ_AT = 0.17  # ms


def options(cell):
    """Settings of a run: the scene's own at 2 mm, lengths in proportion."""
    ratio = cell / 2.0
    return [f"grid.cell_size={cell:g}", f"bodies.plate.spacing={ratio:g}", f"bodies.rod.spacing.0={0.62 * ratio:g}",
            f"bodies.rod.spacing.1={0.62 * ratio:g}", f"bodies.rod.spacing.2={ratio:g}", "output.particle_interval=0",
            "output.checkpoint_steps=0", "numerics.threads=0"]


def contact_case(output, identity, speed, rod, detection, cell):
    settings = options(cell) + [f"parameters.V0={speed}", f"bodies.rod.formulation={'rigid' if rod == 'rigid' else 'deformable'}",
                                f"contact.detection={detection}"]
    return Case(os.path.join(output, f"{speed}_{rod}_{detection}_{cell:g}"),
                [word for option in settings for word in ("--set", option)], identity)


def speed_at(case, time):
    """Of the rod, from the run's history; its last one where the run ended before."""
    with open(os.path.join(case.directory, "history.csv"), encoding="utf-8") as file:
        rows = [(float(row["time"]), float(row["rod.speed"])) for row in csv.DictReader(file)]
    return min(rows, key=lambda row: abs(row[0] - time))[1]


def contact_tables(arguments, engine, identity):
    output = os.path.join(TOP, "out", "validation", "surface_contact")
    order = [(speed, rod, cell) for speed in SPEEDS for rod in ("rigid", "elastic") for cell in CELLS]
    cases = {key: {detection: contact_case(output, identity, key[0], key[1], detection, key[2])
                   for detection in ("gap", "surface")} for key in order}
    if not arguments.tables_only:
        wanted = [case for key in order if key[0] in arguments.speeds and key[2] in arguments.cells
                  for case in cases[key].values()]
        run_cases(wanted, arguments.program, engine, SCENE, 1)
    lines, records = [], []
    for (speed, rod, cell), pair in cases.items():
        texts, values = [f"{speed}", rod, f"{cell:g}"], [speed, rod, cell]
        for case in pair.values():
            summary = (case.outcome() or {}).get("summary")
            if not summary:
                texts += ["-"] * 4
                values += [""] * 4
                continue
            numbers = [speed_at(case, READ_AT), summary["results"]["residual_velocity"],
                       100 * summary["energy"]["residual_relative"], summary["maximum_speed_ever"] / speed]
            texts += [f"{numbers[0]:.1f}", f"{numbers[1]:.1f}", f"{numbers[2]:+.2f}", f"{numbers[3]:.2f}"]
            values += [f"{number:.6g}" for number in numbers]
        if set(texts[3:]) != {"-"}:
            lines.append(texts)
            records.append(values)
    if not lines:
        raise Refused(f"{output}: no runs of this engine and scene")
    columns = ["speed at 170 us", "Vr", "energy %", "fastest / V0"]
    text = markdown_table(["V0", "rod", "cell mm"] + [f"gap: {name}" for name in columns] +
                          [f"surface: {name}" for name in columns], lines)
    done = [case.directory for pair in cases.values() for case in pair.values() if (case.outcome() or {}).get("summary")]
    text = last_run(done) + "\n\n" + text
    print(text)
    replace_block(os.path.join(TOP, "docs", "validation.md"), "surface-contact", text)
    with open(os.path.join(TOP, "docs", "data", "surface_contact.csv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        names = ["speed_170us", "residual_velocity", "energy_residual_percent", "fastest_over_v0"]
        writer.writerow(["v0", "rod", "cell_mm"] + [f"gap_{name}" for name in names] + [f"surface_{name}" for name in names])
        writer.writerows(records)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=float, nargs="+", metavar="MM", help="run these")
    parser.add_argument("--contact", action="store_true", help="compare detection of contact by gap and by surface")
    parser.add_argument("--speeds", type=int, nargs="+", default=SPEEDS[:1], metavar="V0", help="with --contact: run these")
    parser.add_argument("--program", default=os.path.join(TOP, "build", "release", "bin", "ogive"))
    parser.add_argument("--tables-only", action="store_true", help="no runs: the table of what is there")
    arguments = parser.parse_args()
    if not arguments.cells:
        arguments.cells = RUN_BY_DEFAULT_FOR_CONTACT if arguments.contact else RUN_BY_DEFAULT
    for speed in arguments.speeds:
        if speed not in SPEEDS:
            raise Refused(f"--speeds {speed}: expected some of " + ", ".join(map(str, SPEEDS)))
    for cell in arguments.cells:
        if cell not in CELLS:
            raise Refused(f"--cells {cell:g}: expected some of " + ", ".join(f"{known:g}" for known in CELLS))

    engine = engine_of(arguments.program)
    identity = {"scene": digest(SCENE, os.path.join(os.path.dirname(SCENE), "rod.stl")), "engine": digest(engine)}
    if arguments.contact:
        contact_tables(arguments, engine, identity)
        return
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
    text = last_run(case.directory for case in cases.values() if case.outcome()) + "\n\n" + text
    print(text)
    replace_block(os.path.join(TOP, "docs", "validation.md"), "convergence", text)
    with open(os.path.join(TOP, "docs", "data", "convergence.csv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["cell_mm", "particles", "residual_velocity", "energy_residual_percent", "transfer_percent",
                         "fastest_over_v0", "time_us", "steps", "wall_seconds"])
        writer.writerows([[f"{value:.6g}" for value in values] for values in records])


if __name__ == "__main__":
    run_main(main)
