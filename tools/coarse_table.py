#!/usr/bin/python3
"""Fewer particles away from the impact: what they save and what they change.

  coarse_table.py [--program build/release/bin/ogive] [--work DIR] [--table-only]

Runs scenes with the plate as it is and with one particle a cell beyond some distances from the path of what hits it, on one
thread, and writes docs/data/coarse.csv and the table between the markers of docs/performance.md. Runs in DIR that are
finished are not run again.
"""

import os
import re
import tempfile

from plot_common import run_main
from validation_table import NO_FILES, markdown_table, read_table, replace_block, run_scene, table_arguments, write_table

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
DATA = os.path.join(ROOT, "docs", "data", "coarse.csv")
PAGE = os.path.join(ROOT, "docs", "performance.md")
# Label: scene, settings, the line of the path, the striker's calibre, distances.
CASES = {
    "thick plate, 575 m/s": ("thick_plate/scene.toml", [], "from=[0,0,0],to=[15.2,0,26.3]", 12.9, [35, 25.8, 19.4, 12.9]),
    "thick plate, 400 m/s": ("thick_plate/scene.toml", ["parameters.V0=400"], "from=[0,0,0],to=[15.2,0,26.3]", 12.9, [25.8]),
    "steel ball, quarter": ("steel_ball/scene.toml", [], "from=[0,0,0],to=[0,0,50]", 10.0, [20, 10]),
}


def rows_of(program, work, label):
    scene, settings, line, calibre, distances = CASES[label]
    rows = []
    for beyond in [None] + distances:
        coarse = [f"bodies.plate.coarse={{beyond={beyond},{line}}}"] if beyond else []
        name = re.sub("[^a-z0-9]+", "-", label) + f"-{beyond or 'all'}"
        summary = run_scene(program, scene, os.path.join(work, name), NO_FILES + settings + coarse)
        rows.append({"case": label, "beyond": beyond or "", "calibres": f"{beyond / calibre:.2g}" if beyond else "",
                     "particles": summary["particles"], "seconds": f"{summary['cpu_seconds']['stepping']:.4g}",
                     "value": f"{summary['results']['residual_velocity']:.8g}",
                     "energy_residual": f"{summary['energy']['residual_relative']:.4g}"})
    return rows


def table(rows):
    lines = []
    whole = {row["case"]: row for row in rows if not row["beyond"]}
    for row in rows:
        base = whole[row["case"]]
        far = f"{row['beyond']} ({row['calibres']})" if row["beyond"] else "nowhere"
        lines.append([row["case"], far, f"{int(row['particles']):,}", row["seconds"],
                      f"{float(base['seconds']) / float(row['seconds']):.2f}", f"{float(row['value']):.6g}",
                      f"{100 * (float(row['value']) / float(base['value']) - 1):+.3f} %",
                      f"{100 * float(row['energy_residual']):+.2f} %"])
    return markdown_table(["case", "one particle a cell beyond [mm] (calibres)", "particles", "processor time [s]", "faster",
                           "residual velocity [m/s]", "difference", "energy unaccounted for"], lines)


def main():
    parser = table_arguments(__doc__, os.path.join(ROOT, "build", "release", "bin", "ogive"))
    arguments = parser.parse_args()
    if not arguments.table_only:
        with tempfile.TemporaryDirectory() as temporary:
            rows = [row for label in CASES for row in rows_of(arguments.program, arguments.work or temporary, label)]
        write_table(DATA, rows)
    rows = read_table(DATA)
    replace_block(PAGE, "coarse", table(rows))
    print(table(rows))


if __name__ == "__main__":
    run_main(main)
