#!/usr/bin/python3
"""What error costs how many cells: runs scenes with finer and finer cells and writes what `accuracy` in a scene goes by.

  resolution_table.py [--program build/release/bin/ogive] [--work DIR] [--jobs N] [--only SCENE] [--table-only]
  resolution_table.py --deliver [--program ...]      runs with accuracy = 10 % and 3 %, and their errors

Writes docs/data/resolution.csv, which the program carries, and the tables between the markers of docs/accuracy.md. The
cells are counted across the thinnest body of the scene. The limit of fine cells is f0 of f0 + C h^p, by least squares over all
cells of the series with p between 1/2 and 4; the error of a run is its distance from that limit. Where p is at one of these
bounds no limit is claimed: the error is the distance from the finest run, whose own error is not known. Particles shrink with
the cells. Runs in DIR that are finished are not run again.
"""

import argparse
import concurrent.futures
import csv
import json
import os
import re
import subprocess
import tempfile

import numpy as np

from plot_common import Refused, run_main

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
DATA = os.path.join(ROOT, "docs", "data", "resolution.csv")
DELIVERED = os.path.join(ROOT, "docs", "data", "accuracy_delivered.csv")
PAGE = os.path.join(ROOT, "docs", "accuracy.md")
ACCURACIES = ("10%", "3%")  # finer than the worst of the series allows is refused
QUIET = ["output.particle_interval=0", "output.checkpoint_steps=0"]


class Series:
    def __init__(self, name, label, file, thinnest, cells, settings, results):
        self.name, self.label, self.file, self.thinnest, self.cells = name, label, file, thinnest, cells
        self.settings, self.results = settings, results


SERIES = [
    Series("thick_plate", "thick plate, 575 m/s", "thick_plate/scene.toml", 12.9, [4, 3, 2, 1.5, 1],
           lambda h: [f"grid.cell_size={h}", f"bodies.plate.spacing={h / 2}", f"bodies.rod.spacing=[{0.31 * h},{0.31 * h},{h / 2}]"],
           {"residual velocity": (["results", "residual_velocity"], "m/s")}),
    Series("steel_ball", "steel ball, axisymmetric", "steel_ball/axisymmetric.toml", 1.0,
           [1.0, 0.66, 0.5, 0.33, 0.25, 0.165, 0.125, 0.1],
           lambda h: [f"parameters.cell={h}", f"parameters.spacing={h / 2}"],
           {"residual velocity": (["results", "residual_velocity"], "m/s")}),
    Series("copper_bar", "copper bar, axisymmetric", "taylor_copper/axisymmetric.toml", 6.4,
           [1.6, 1.0, 0.8, 0.5, 0.4, 0.25, 0.2, 0.1],
           lambda h: [f"parameters.cell={h}", f"parameters.spacing={h / 2}"],
           {"final length": (["bodies", "bar", "upper", 1], "mm"), "radius of the foot": (["bodies", "bar", "upper", 0], "mm")}),
]


def value_of(summary, path):
    for key in path:
        summary = summary[key]
    return float(summary)


def edge(series, result, spacing):
    """The outermost particles' surface is half a spacing beyond their centres."""
    return 0.5 * spacing if series.name == "copper_bar" else 0.0


def run(program, work, series, label, settings):
    directory = os.path.join(work, f"{series.name}-{label}")
    summary = os.path.join(directory, "summary.json")
    if not os.path.exists(summary):
        command = [program, "run", os.path.join(ROOT, "examples", "scenes", series.file), "-o", directory, "--overwrite"]
        command += [part for setting in QUIET + settings for part in ("--set", setting)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(summary, encoding="utf-8") as file:
        return json.load(file)


def limit_of(cells, values):
    """(f0, p) of the best f0 + C h^p, None where there is none."""
    best = None
    for p in np.arange(0.5, 4.001, 0.01):
        matrix = np.stack([np.ones(len(cells)), np.asarray(cells) ** p], axis=1)
        solution = np.linalg.lstsq(matrix, np.asarray(values), rcond=None)[0]
        misfit = float(np.sum((matrix @ solution - values) ** 2))
        if best is None or misfit < best[0]:
            best = misfit, float(solution[0]), float(p)
    return (best[1], best[2]) if 0.5 < best[2] < 3.99 else None


def rows_of(series, summaries):
    rows = []
    for result, (path, _) in series.results.items():
        values = [value_of(summaries[h], path) + edge(series, result, h / 2) for h in series.cells]
        limit = limit_of(series.cells, values)
        for h, value in zip(series.cells, values):
            known = limit or h != min(series.cells)
            error = value / (limit[0] if limit else values[series.cells.index(min(series.cells))]) - 1
            rows.append({"scene": series.name, "result": result, "cells_across": f"{series.thinnest / h:.4g}", "cell": f"{h:g}",
                         "value": f"{value:.6g}", "error": f"{error:.5f}" if known else "",
                         "limit": f"{limit[0]:.6g}" if limit else "", "order": f"{limit[1]:.2f}" if limit else "",
                         "particles": summaries[h]["particles"],
                         "seconds": f"{summaries[h]['cpu_seconds']['stepping']:.3g}"})
    return rows


def by_name(name):
    return next(series for series in SERIES if series.name == name)


def percent(error):
    return f"{100 * float(error):+.2f} %" if error else "not known"


def table(rows):
    lines = ["| scene, result | cells across the thinnest body | cell [mm] | value | error | limit (order) | processor time [s] |",
             "|---|---|---|---|---|---|---|"]
    for row in rows:
        series = by_name(row["scene"])
        lines.append(f"| {series.label}, {row['result']} | {row['cells_across']} | {row['cell']} | {row['value']} "
                     f"{series.results[row['result']][1]} | {percent(row['error'])} | "
                     f"{row['limit'] + ' (' + row['order'] + ')' if row['limit'] else 'none; from the finest'} | "
                     f"{row['seconds']} |")
    return "\n".join(lines)


def delivered_rows(program, work, rows):
    out = []
    for series in SERIES:
        for accuracy in ACCURACIES:
            summary = run(program, work, series, "accuracy-" + accuracy.rstrip("%"), [f"accuracy={accuracy}"])
            decision = next(d for d in summary["plan"]["decisions"] if d["subject"] == "accuracy")["decision"]
            cell = float(re.match(r"cells of (\S+)", decision)[1])
            for result, (path, _) in series.results.items():
                of = [row for row in rows if row["scene"] == series.name and row["result"] == result]
                value = value_of(summary, path) + edge(series, result, cell / 2)
                finest = float(of[-1]["value"])
                out.append({"scene": series.name, "result": result, "accuracy": accuracy, "cell": f"{cell:.4g}",
                            "value": f"{value:.6g}", "error": f"{value / float(of[-1]['limit']) - 1:.5f}" if of[-1]["limit"] else "",
                            "from_finest": f"{value / finest - 1:.5f}", "seconds": f"{summary['cpu_seconds']['stepping']:.3g}"})
    return out


def delivered_table(rows):
    lines = ["| scene, result | asked | cell taken [mm] | value | off the finest run | off the limit | processor time [s] |",
             "|---|---|---|---|---|---|---|"]
    for row in rows:
        series = by_name(row["scene"])
        lines.append(f"| {series.label}, {row['result']} | {row['accuracy']} | {row['cell']} | {row['value']} "
                     f"{series.results[row['result']][1]} | {percent(row['from_finest'])} | {percent(row['error'])} | "
                     f"{row['seconds']} |")
    return "\n".join(lines)


def read(path):
    if not os.path.exists(path):
        return []
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


def write(path, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "release", "bin", "ogive"))
    parser.add_argument("--work", help="where the runs go (default: a temporary directory)")
    parser.add_argument("--jobs", type=int, default=1, help="runs at once")
    parser.add_argument("--only", choices=[series.name for series in SERIES])
    parser.add_argument("--deliver", action="store_true", help="run with accuracy, by a program that carries the data")
    parser.add_argument("--table-only", action="store_true", help="no runs: the tables from the data")
    arguments = parser.parse_args()
    rows = read(DATA)
    with tempfile.TemporaryDirectory() as temporary:
        work = arguments.work or temporary
        os.makedirs(work, exist_ok=True)
        if arguments.deliver:
            write(DELIVERED, delivered_rows(arguments.program, work, rows))
        elif not arguments.table_only:
            chosen = [series for series in SERIES if arguments.only in (None, series.name)]
            cases = [(series, h) for series in chosen for h in sorted(series.cells)]
            with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
                done = list(pool.map(lambda case: run(arguments.program, work, case[0], f"{case[1]:g}", case[0].settings(case[1])), cases))
            summaries = {series.name: {h: s for (of, h), s in zip(cases, done) if of is series} for series in chosen}
            fresh = {series.name: rows_of(series, summaries[series.name]) for series in chosen}
            rows = [row for series in SERIES
                    for row in fresh.get(series.name, [row for row in rows if row["scene"] == series.name])]
            write(DATA, rows)
    with open(PAGE, encoding="utf-8") as file:
        page = file.read()
    for name, text in (("resolution", table(rows)), ("delivered", delivered_table(read(DELIVERED)))):
        page, count = re.subn(rf"(<!-- {name}:begin -->\n).*?(<!-- {name}:end -->)", lambda m: m[1] + text + "\n" + m[2], page,
                              flags=re.DOTALL)
        if count != 1:
            raise Refused(f"docs/accuracy.md has no place for {name}")
    with open(PAGE, "w", encoding="utf-8") as file:
        file.write(page)
    print(table(rows), delivered_table(read(DELIVERED)), sep="\n\n")


if __name__ == "__main__":
    run_main(main)
