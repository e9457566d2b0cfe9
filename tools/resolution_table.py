#!/usr/bin/python3
"""What error costs how many cells: runs scenes with finer and finer cells and writes what `accuracy` in a scene goes by.

  resolution_table.py [--program build/release/bin/ogive] [--work DIR] [--jobs N] [--only SCENE] [--table-only]
  resolution_table.py --factors [--program ...]      the same scenes with smaller and larger time steps
  resolution_table.py --deliver [--program ...]      runs with accuracy = 10 % and 3 %, and their errors

Writes docs/data/resolution.csv and docs/data/time_step_factor.csv, which the program carries, and the tables between the
markers of docs/accuracy.md. The cells are counted across the thinnest body of the scene. The limit of fine cells is f0 of
f0 + C h^p, by least squares over all cells of the series with p between 1/2 and 4; the error of a run is its distance from
that limit. Where p is at one of these bounds no limit is claimed: the error is the distance from the finest run, whose own
error is not known. Particles shrink with the cells. Runs in DIR that are finished are not run again.
"""

import concurrent.futures
import os
import re
import tempfile

import numpy as np

from plot_common import run_main
from validation_table import (NO_FILES, markdown_table, read_table, replace_block, run_scene,
                              table_arguments, value_of, write_table)

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
DATA = os.path.join(ROOT, "docs", "data", "resolution.csv")
FACTOR_DATA = os.path.join(ROOT, "docs", "data", "time_step_factor.csv")
DELIVERED = os.path.join(ROOT, "docs", "data", "accuracy_delivered.csv")
PAGE = os.path.join(ROOT, "docs", "accuracy.md")
ACCURACIES = ("10%", "3%")  # finer than the worst of the series allows is refused
FACTORS = (0.125, 0.25, 0.5, 0.8)
FACTOR_CELLS = {"thick_plate": (4, 3), "steel_ball": (0.33, 0.25), "copper_bar": (1.6, 0.8)}  # about 4 and 8 across


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


def edge(series, result, spacing):
    """The outermost particles' surface is half a spacing beyond their centres."""
    return 0.5 * spacing if series.name == "copper_bar" else 0.0


def run(program, work, series, label, settings):
    return run_scene(program, series.file, os.path.join(work, f"{series.name}-{label}"), NO_FILES + settings)


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


def factor_rows(program, work, jobs):
    cases = [(series, h, factor) for series in SERIES for h in FACTOR_CELLS[series.name] for factor in FACTORS]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        done = list(pool.map(lambda case: run(program, work, case[0], f"{case[1]:g}-factor-{case[2]:g}",
                                              case[0].settings(case[1]) + [f"numerics.time_step_factor={case[2]}"]), cases))
    summaries = dict(zip(cases, done))
    rows = []
    for series in SERIES:
        for result, (path, _) in series.results.items():
            for h in FACTOR_CELLS[series.name]:
                smallest = value_of(summaries[series, h, FACTORS[0]], path) + edge(series, result, h / 2)
                for factor in FACTORS:
                    summary = summaries[series, h, factor]
                    value = value_of(summary, path) + edge(series, result, h / 2)
                    rows.append({"scene": series.name, "result": result, "cells_across": f"{series.thinnest / h:.4g}",
                                 "cell": f"{h:g}", "factor": f"{factor:g}", "value": f"{value:.6g}",
                                 "change": f"{value / smallest - 1:.5f}",
                                 "seconds": f"{summary['cpu_seconds']['stepping']:.3g}"})
    return rows


def factor_table(rows):
    lines = []
    for begin in range(0, len(rows), len(FACTORS)):
        part = rows[begin:begin + len(FACTORS)]
        series = by_name(part[0]["scene"])
        unit = series.results[part[0]["result"]][1]
        cells = [f"{row['value']} {unit} ({percent(row['change'])}), {row['seconds']} s" for row in part]
        lines.append([f"{series.label}, {part[0]['result']}", part[0]["cell"], *cells])
    return markdown_table(["scene, result", "cell [mm]"] + [f"factor {factor:g}" for factor in FACTORS], lines)


def by_name(name):
    return next(series for series in SERIES if series.name == name)


def percent(error):
    return f"{100 * float(error):+.2f} %" if error else "not known"


def table(rows):
    lines = []
    for row in rows:
        series = by_name(row["scene"])
        lines.append([f"{series.label}, {row['result']}", row["cells_across"], row["cell"],
                      f"{row['value']} {series.results[row['result']][1]}", percent(row["error"]),
                      f"{row['limit']} ({row['order']})" if row["limit"] else "none; from the finest", row["seconds"]])
    return markdown_table(["scene, result", "cells across the thinnest body", "cell [mm]", "value", "error", "limit (order)",
                           "processor time [s]"], lines)


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
    lines = []
    for row in rows:
        series = by_name(row["scene"])
        lines.append([f"{series.label}, {row['result']}", row["accuracy"], row["cell"],
                      f"{row['value']} {series.results[row['result']][1]}", percent(row["from_finest"]),
                      percent(row["error"]), row["seconds"]])
    return markdown_table(["scene, result", "asked", "cell taken [mm]", "value", "off the finest run", "off the limit",
                           "processor time [s]"], lines)


def main():
    parser = table_arguments(__doc__, os.path.join(ROOT, "build", "release", "bin", "ogive"))
    parser.add_argument("--jobs", type=int, default=1, help="runs at once")
    parser.add_argument("--only", choices=[series.name for series in SERIES])
    parser.add_argument("--factors", action="store_true", help="run with smaller and larger time steps")
    parser.add_argument("--deliver", action="store_true", help="run with accuracy, by a program that carries the data")
    arguments = parser.parse_args()
    rows = read_table(DATA)
    with tempfile.TemporaryDirectory() as temporary:
        work = arguments.work or temporary
        os.makedirs(work, exist_ok=True)
        if arguments.factors:
            write_table(FACTOR_DATA, factor_rows(arguments.program, work, arguments.jobs))
        elif arguments.deliver:
            write_table(DELIVERED, delivered_rows(arguments.program, work, rows))
        elif not arguments.table_only:
            chosen = [series for series in SERIES if arguments.only in (None, series.name)]
            cases = [(series, h) for series in chosen for h in sorted(series.cells)]
            with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
                done = list(pool.map(lambda case: run(arguments.program, work, case[0], f"{case[1]:g}", case[0].settings(case[1])), cases))
            summaries = {series.name: {h: s for (of, h), s in zip(cases, done) if of is series} for series in chosen}
            fresh = {series.name: rows_of(series, summaries[series.name]) for series in chosen}
            rows = [row for series in SERIES
                    for row in fresh.get(series.name, [row for row in rows if row["scene"] == series.name])]
            write_table(DATA, rows)
    for name, text in (("resolution", table(rows)), ("factors", factor_table(read_table(FACTOR_DATA))),
                       ("delivered", delivered_table(read_table(DELIVERED)))):
        replace_block(PAGE, name, text)
    print(table(rows), delivered_table(read_table(DELIVERED)), sep="\n\n")


if __name__ == "__main__":
    run_main(main)
