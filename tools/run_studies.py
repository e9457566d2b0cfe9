#!/usr/bin/python3
"""The studies of docs/accuracy.md: runs what is not there yet, draws the charts, writes the tables.

  run_studies.py                          all of studies/*.toml (about 40 minutes of one core)
  run_studies.py --studies plate_impact   these alone are run; documents show what is there
  run_studies.py --tables-only            no runs

Each study's study.csv goes to docs/data/studies, its charts to docs/images, and its part of docs/accuracy.md is written anew: the
front of error and cost, the cheapest setting within 10, 3 and 1 %, and the limits of fine cells with their uncertainty.
"""

import argparse
import json
import os
import shutil
import subprocess

from plot_common import Refused, run_main
from validation_table import markdown_table, replace_block

TOP = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
STUDIES = ["thick_plate", "plate_impact", "taylor_bar", "rings", "rolling_sphere", "steel_ball"]
DOCUMENT = os.path.join(TOP, "docs", "accuracy.md")
GOALS = [10, 3, 1]


def load(directory):
    try:
        with open(os.path.join(directory, "study.json"), encoding="utf-8") as file:
            return json.load(file)
    except FileNotFoundError:
        return None


class Results:
    def __init__(self, study):
        self.study = study
        self.cases = study["cases"]
        self.measures = {measure["name"]: measure for measure in study["measures"]}
        self.varied = [axis for axis in study["axes"] if len({case["labels"].get(axis) for case in self.cases} - {None}) > 1]
        self.per = [axis for axis in study["charts"]["per"] if axis in self.varied]

    def error(self, case, name):
        """In percent where it is relative."""
        error = case["values"].get(name, {}).get("error")
        return None if error is None else error * (100 if self.measures[name]["error"] == "relative" else 1)

    def kind(self, case):
        return tuple(case["labels"].get(axis) for axis in self.per)

    def kind_name(self, kind):
        return ", ".join(f"{axis} {label}" for axis, label in zip(self.per, kind) if label is not None) or "all"

    def name(self, case):
        return ", ".join(f"{axis} {case['labels'][axis]}" for axis in self.varied if axis in case["labels"] and axis not in self.per)

    def cheapest(self, name, kind, goal):
        """The cheapest case that does not fail and whose error is within the goal."""
        chosen = [case for case in self.cases if self.kind(case) == kind and case["verdict"] != "fails"
                  and (error := self.error(case, name)) is not None and abs(error) <= goal]
        return min(chosen, key=lambda case: case["cost"]["cpu_seconds"], default=None)


def goals_table(results, name):
    lines = []
    for kind in dict.fromkeys(map(results.kind, results.cases)):
        if not any(results.error(case, name) is not None for case in results.cases if results.kind(case) == kind):
            continue
        for goal in GOALS:
            case = results.cheapest(name, kind, goal)
            lines.append([results.kind_name(kind), f"{goal} %", "none of these" if case is None else results.name(case),
                          "" if case is None else f"{results.error(case, name):+.2f}",
                          "" if case is None else f"{case['cost']['cpu_seconds']:.1f}", "" if case is None else case["verdict"]])
    return markdown_table(["case", "error within", "cheapest setting", f"error of {name} %", "processor s", "verdict"], lines)


def limits_table(results):
    lines = []
    for series in results.study["convergence"]:
        if series["limit"] is None or len(series["cells"]) < 3 or not series["order"]:
            continue
        measure = results.measures[series["measure"]]
        cells = sorted(zip(series["cells"], series["values"]), reverse=True)
        lines.append([series["measure"], ", ".join(f"{axis} {label}" for axis, label in series["labels"].items() if axis in results.varied),
                      ", ".join(f"{cell:g}: {value:.4g}" for cell, value in cells),
                      f"{series['limit']:.4g} ± {series['uncertainty']:.2g} {measure['unit']}", f"{series['order']:.2f}"])
    return markdown_table(["measure", "series", "cell: value", "limit", "order"], lines) if lines else ""


def errors_table(results):
    """Every case of the finest cell of each series: all errors beside each other."""
    names = [name for name in results.measures if any(results.error(case, name) is not None for case in results.cases)]
    finest = {}
    cell = results.study["charts"]["cell"]
    for case in results.cases:
        if case["ending"] != "done":
            continue
        key = tuple(label for axis, label in sorted(case["labels"].items()) if axis != cell)
        if key not in finest or (cell and float(case["labels"].get(cell, 0)) < float(finest[key]["labels"].get(cell, 0))):
            finest[key] = case
    lines = []
    for case in finest.values():
        line = [results.kind_name(results.kind(case)), results.name(case)]
        for name in names:
            value, error = case["values"].get(name, {}).get("value"), results.error(case, name)
            line += ["–" if value is None else f"{value:.4g}", "–" if error is None else f"{error:+.1f}"]
        lines.append(line + [f"{100 * case['energy_residual']:+.2f}", f"{case['cost']['cpu_seconds']:.1f}", case["verdict"]])
    heading = ["case", "setting (its finest cell)"]
    for name in names:
        heading += [f"{name} {results.measures[name]['unit']}", "error " + ("%" if results.measures[name]["error"] == "relative" else results.measures[name]["unit"])]
    return markdown_table(heading + ["energy %", "processor s", "verdict"], lines)


def text_of(name, study):
    results = Results(study)
    charted = study["charts"]["error"]
    failed = [case for case in study["cases"] if case["verdict"] == "fails"]
    parts = [f"`studies/{name}.toml`: {len(study['cases'])} cases, {len(failed)} of them fail"
             + ("" if study["complete"] else "; **not complete**: made with `ogive study` as far as time allowed") + "."]
    if any(results.error(case, charted) is not None for case in study["cases"]):
        parts.append(goals_table(results, charted))
    limits = limits_table(results)
    if limits:
        parts.append("Limits of fine cells, f0 + C h^p:\n\n" + limits)
    parts.append("<details><summary>All series</summary>\n\n" + errors_table(results) + "\n\n</details>")
    return "\n\n".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--studies", nargs="+", choices=STUDIES, default=STUDIES, metavar="STUDY", help="of " + ", ".join(STUDIES))
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="cases at once (default: processors)")
    parser.add_argument("--program", default=os.path.join(TOP, "build", "release", "bin", "ogive"))
    parser.add_argument("--output", default=os.path.join(TOP, "out", "studies"), help="directory of the runs (default out/studies)")
    parser.add_argument("--tables-only", action="store_true", help="no runs: charts and tables of what is there")
    arguments = parser.parse_args()
    if not arguments.tables_only and not os.path.exists(arguments.program):
        raise Refused(f"{arguments.program}: not there; build with: cmake --preset release && cmake --build --preset release")
    for name in [] if arguments.tables_only else arguments.studies:
        print(name, flush=True)
        subprocess.run([arguments.program, "study", os.path.join(TOP, "studies", name + ".toml"), "--output",
                        os.path.join(arguments.output, name), "--cache", os.path.join(arguments.output, "cases"), "--jobs",
                        str(arguments.jobs)], check=True)
    os.makedirs(os.path.join(TOP, "docs", "data", "studies"), exist_ok=True)
    for name in STUDIES:
        directory = os.path.join(arguments.output, name)
        study = load(directory)
        if not study:
            continue
        shutil.copyfile(os.path.join(directory, "study.csv"), os.path.join(TOP, "docs", "data", "studies", name + ".csv"))
        subprocess.run([os.path.join(TOP, "tools", "plot_study.py"), directory, "--png", "--output",
                        os.path.join(TOP, "docs", "images", "study_" + name)], check=True)
        replace_block(DOCUMENT, "study-" + name.replace("_", "-"), text_of(name, study), f"\n## {study['title']}\n")


if __name__ == "__main__":
    run_main(main)
