#!/usr/bin/python3
"""Draws the charts of a study from its study.json, as PNG and SVG: error against processor time, error against cell size,
where the time goes.

  plot_study.py DIR                      DIR/study.json; pictures beside it, for the measure that the study charts
  plot_study.py DIR --measure Vr -o docs/images/thick_plate
                                         another measure; pictures docs/images/thick_plate-cost.png ...
"""

import argparse
import json
import math
import os
import signal

from plot_common import Refused, plt, run_main

MARKERS = "osD^vP*Xh<>d"
COLOURS = ["#1f6feb", "#d4380d", "#2da44e", "#8250df", "#bf8700", "#0e8a9e", "#c2338b", "#57606a", "#7a4b21", "#3b5bdb"]


def error_of(case, measure):
    """|error| in percent where it is relative; None where there is none."""
    error = case["values"].get(measure["name"], {}).get("error")
    if error is None or error == 0:
        return None
    return abs(error) * (100 if measure["error"] == "relative" else 1)


class Study:
    def __init__(self, directory):
        path = os.path.join(directory, "study.json")
        with open(path, encoding="utf-8") as file:
            self.json = json.load(file)
        if self.json.get("format") != "ogive-study":
            raise Refused(f"{path}: is not a study of Ogive")
        self.cases = self.json["cases"]
        self.axes = [axis for axis in self.json["axes"] if len(self.values(axis)) > 1]
        self.cell = self.json["charts"]["cell"]
        self.per = [axis for axis in self.json["charts"]["per"] if axis in self.axes]

    def values(self, axis):
        """Labels on an axis in the order in which they first occur."""
        return list(dict.fromkeys(case["labels"][axis] for case in self.cases if axis in case["labels"]))

    def kinds(self):
        """What is computed: one panel each."""
        return list(dict.fromkeys(tuple(case["labels"].get(axis) for axis in self.per) for case in self.cases))

    def of_kind(self, kind):
        return [case for case in self.cases if tuple(case["labels"].get(axis) for axis in self.per) == kind]

    def kind_name(self, kind):
        return ", ".join(f"{axis} {label}" for axis, label in zip(self.per, kind) if label is not None) or self.json["title"]

    def series_name(self, case, leave_out=()):
        return ", ".join(case["labels"][axis] if not case["labels"][axis].replace(".", "").isdigit() else
                         f"{axis} {case['labels'][axis]}" for axis in self.axes
                         if axis in case["labels"] and axis not in (*self.per, *leave_out))


def panels(count):
    columns = min(count, 2)
    rows = math.ceil(count / columns)
    figure, axes = plt.subplots(rows, columns, figsize=(5.6 * columns, 4.2 * rows), squeeze=False)
    for spare in axes.flat[count:]:
        spare.set_visible(False)
    return figure, list(axes.flat)


ENDINGS = ["png", "svg"]


def save(figure, base, name):
    for ending in ENDINGS:
        figure.savefig(f"{base}-{name}.{ending}", dpi=110)
    plt.close(figure)
    print(f"{base}-{name}.png")


def styles(study, leave_out):
    names = list(dict.fromkeys(study.series_name(case, leave_out) for case in study.cases))
    return {name: {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)]} for i, name in enumerate(names)}


def legend_below(figure, handles):
    if handles:
        figure.legend(handles.values(), handles.keys(), loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=2, fontsize=8)


def draw_cost(study, measure, base):
    """One panel for each thing computed; the front joins what no other case beats in both."""
    kinds = [kind for kind in study.kinds() if sum(error_of(c, measure) is not None for c in study.of_kind(kind)) > 1]
    if not kinds:
        return
    figure, axes = panels(len(kinds))
    style = styles(study, (study.cell,))
    handles = {}
    for axis, kind in zip(axes, kinds):
        points = [(case["cost"]["cpu_seconds"], error_of(case, measure), case) for case in study.of_kind(kind)
                  if error_of(case, measure) is not None]
        for seconds, error, case in points:
            name = study.series_name(case, (study.cell,))
            failed = case["verdict"] == "fails"
            handle, = axis.plot([seconds], [error], linestyle="", markersize=6, alpha=0.35 if failed else 1,
                                markerfacecolor="none" if case["verdict"] != "stable" else None, **style[name])
            handles.setdefault(name, handle)
            if study.cell in case["labels"]:
                axis.annotate(case["labels"][study.cell], (seconds, error), textcoords="offset points", xytext=(4, 3), fontsize=6.5)
        front, best = [], math.inf
        for seconds, error, case in sorted(points, key=lambda point: point[:2]):
            if error < best and case["verdict"] != "fails":
                front.append((seconds, error))
                best = error
        axis.plot(*zip(*front), color="black", linewidth=1, zorder=0)
        axis.set(xscale="log", yscale="log", xlabel="processor time [s]", title=study.kind_name(kind),
                 ylabel=f"|error| of {measure['name']} [{'%' if measure['error'] == 'relative' else measure['unit']}]")
        axis.grid(which="both", alpha=0.25)
    figure.tight_layout()
    legend_below(figure, handles)
    save(figure, base, "cost")


def draw_cells(study, measure, base):
    """Lines of cases that differ in the cell alone; in brackets the slope, the order observed."""
    if not study.cell:
        return
    lines = {}
    for case in study.cases:
        error, label = error_of(case, measure), case["labels"].get(study.cell)
        if error is None or label is None:
            continue
        kind = tuple(case["labels"].get(axis) for axis in study.per)
        lines.setdefault((kind, study.series_name(case, (study.cell,))), []).append((float(label), error, case))
    lines = {key: sorted(points, key=lambda point: point[:2]) for key, points in lines.items() if len({p[0] for p in points}) > 1}
    if not lines:
        return
    kinds = list(dict.fromkeys(kind for kind, _ in lines))
    figure, axes = panels(len(kinds))
    style = styles(study, (study.cell,))
    for axis, kind in zip(axes, kinds):
        for (of, name), points in lines.items():
            if of != kind:
                continue
            order = next((series["error_order"] for series in study.json["convergence"] if series["measure"] == measure["name"]
                          and all(points[0][2]["labels"].get(a) == label for a, label in series["labels"].items())), None)
            axis.plot([p[0] for p in points], [p[1] for p in points],
                      label=name + (f" [{order:.1f}]" if order is not None else ""), linewidth=1.2, **style[name])
        axis.set(xscale="log", yscale="log", xlabel="cell size", title=study.kind_name(kind),
                 ylabel=f"|error| of {measure['name']} [{'%' if measure['error'] == 'relative' else measure['unit']}]")
        cells = sorted({point[0] for (of, _), points in lines.items() if of == kind for point in points})
        axis.set_xticks(cells, [f"{cell:g}" for cell in cells])
        axis.minorticks_off()
        axis.grid(which="both", alpha=0.25)
        axis.legend(fontsize=6.5)
    figure.tight_layout()
    save(figure, base, "cells")


def draw_split(study, base):
    """Processor time of the dearest cases by what it was spent on, and the time of a particle and step."""
    cases = [case for case in study.cases if case["cost"]["stepping_seconds"] is not None and case["cost"]["particle_steps"]]
    cases = sorted(cases, key=lambda case: -case["cost"]["cpu_seconds"])[:30][::-1]
    if not cases:
        return
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 1.2 + 0.2 * len(cases)), sharey=True, width_ratios=[2, 1])
    names = [study.series_name(case) + "".join(f", {axis} {case['labels'][axis]}" for axis in study.per if axis in case["labels"])
             or study.json["title"] for case in cases]
    places = range(len(cases))
    start = [0.0] * len(cases)
    for key, label, colour in (("start_seconds", "start: particles, grid", "#bf8700"), ("stepping_seconds", "steps", "#1f6feb"),
                               ("output_seconds", "output", "#2da44e")):
        values = [case["cost"][key] or 0.0 for case in cases]
        left.barh(places, values, left=start, label=label, color=colour)
        start = [a + b for a, b in zip(start, values)]
    left.set_yticks(places, names, fontsize=6.5)
    left.set(xlabel="processor time [s]")
    left.legend(fontsize=7)
    right.barh(places, [1e9 * case["cost"]["stepping_seconds"] / case["cost"]["particle_steps"] for case in cases], color="#8c959f")
    right.set(xlabel="ns a particle and step")
    figure.tight_layout()
    save(figure, base, "split")


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="of a study, with study.json")
    parser.add_argument("--measure", help="whose error is drawn (default: the study's own choice)")
    parser.add_argument("-o", "--output", metavar="BASE", help="beginning of the pictures' names (default DIR/study)")
    parser.add_argument("--png", action="store_true", help="PNG alone")
    arguments = parser.parse_args()
    if arguments.png:
        ENDINGS.remove("svg")
    study = Study(arguments.directory)
    base = arguments.output or os.path.join(arguments.directory, "study")
    measures = {measure["name"]: measure for measure in study.json["measures"]}
    name = arguments.measure or study.json["charts"]["error"]
    if arguments.measure and name not in measures:
        raise Refused(f"--measure {name}: expected one of " + ", ".join(measures))
    if name:
        draw_cost(study, measures[name], base)
        draw_cells(study, measures[name], base)
    draw_split(study, base)


if __name__ == "__main__":
    run_main(main)
