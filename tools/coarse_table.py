#!/usr/bin/python3
"""Fewer particles away from the impact: what they save and what they change.

  coarse_table.py [--program build/release/bin/ogive] [--work DIR] [--table-only]

Runs scenes with the plate as it is and with one particle a cell beyond some distances from the path of what hits it, on one
thread, and writes docs/data/coarse.csv and the table between the markers of docs/performance.md. Runs in DIR that are
finished are not run again.
"""

import argparse
import csv
import json
import os
import re
import subprocess
import tempfile

from plot_common import Refused, run_main

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
DATA = os.path.join(ROOT, "docs", "data", "coarse.csv")
PAGE = os.path.join(ROOT, "docs", "performance.md")
QUIET = ["output.particle_interval=0", "output.checkpoint_steps=0", "numerics.threads=1"]
# Label: scene, settings, the line of the path, the striker's calibre, distances.
CASES = {
    "thick plate, 575 m/s": ("thick_plate/scene.toml", [], "from=[0,0,0],to=[15.2,0,26.3]", 12.9, [35, 25.8, 19.4, 12.9]),
    "thick plate, 400 m/s": ("thick_plate/scene.toml", ["parameters.V0=400"], "from=[0,0,0],to=[15.2,0,26.3]", 12.9, [25.8]),
    "steel ball, quarter": ("steel_ball/scene.toml", [], "from=[0,0,0],to=[0,0,50]", 10.0, [20, 10]),
}


def run(program, directory, scene, settings):
    summary = os.path.join(directory, "summary.json")
    if not os.path.exists(summary):
        command = [program, "run", os.path.join(ROOT, "examples", "scenes", scene), "-o", directory, "--overwrite"]
        subprocess.run(command + [part for setting in QUIET + settings for part in ("--set", setting)], check=True,
                       stdout=subprocess.DEVNULL)
    with open(summary, encoding="utf-8") as file:
        return json.load(file)


def rows_of(program, work, label):
    scene, settings, line, calibre, distances = CASES[label]
    rows = []
    for beyond in [None] + distances:
        coarse = [f"bodies.plate.coarse={{beyond={beyond},{line}}}"] if beyond else []
        name = re.sub("[^a-z0-9]+", "-", label) + f"-{beyond or 'all'}"
        summary = run(program, os.path.join(work, name), scene, settings + coarse)
        rows.append({"case": label, "beyond": beyond or "", "calibres": f"{beyond / calibre:.2g}" if beyond else "",
                     "particles": summary["particles"], "seconds": f"{summary['cpu_seconds']['stepping']:.4g}",
                     "value": f"{summary['results']['residual_velocity']:.8g}",
                     "energy_residual": f"{summary['energy']['residual_relative']:.4g}"})
    return rows


def table(rows):
    lines = ["| case | one particle a cell beyond [mm] (calibres) | particles | processor time [s] | faster | residual velocity [m/s] | "
             "difference | energy unaccounted for |", "|---|---|---|---|---|---|---|---|"]
    whole = {row["case"]: row for row in rows if not row["beyond"]}
    for row in rows:
        base = whole[row["case"]]
        far = f"{row['beyond']} ({row['calibres']})" if row["beyond"] else "nowhere"
        lines.append(f"| {row['case']} | {far} | {int(row['particles']):,} | {row['seconds']} | "
                     f"{float(base['seconds']) / float(row['seconds']):.2f} | {float(row['value']):.6g} | "
                     f"{100 * (float(row['value']) / float(base['value']) - 1):+.3f} % | {100 * float(row['energy_residual']):+.2f} % |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "release", "bin", "ogive"))
    parser.add_argument("--work", help="where the runs go (default: a temporary directory)")
    parser.add_argument("--table-only", action="store_true", help="no runs: the table from the data")
    arguments = parser.parse_args()
    if not arguments.table_only:
        with tempfile.TemporaryDirectory() as temporary:
            rows = [row for label in CASES for row in rows_of(arguments.program, arguments.work or temporary, label)]
        with open(DATA, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    with open(DATA, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    page, count = re.subn(r"(<!-- coarse:begin -->\n).*?(<!-- coarse:end -->)", lambda m: m[1] + table(rows) + "\n" + m[2], page,
                          flags=re.DOTALL)
    if count != 1:
        raise Refused("docs/performance.md has no place for coarse")
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(page)
    print(table(rows))


if __name__ == "__main__":
    run_main(main)
