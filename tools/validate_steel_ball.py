#!/usr/bin/python3
"""Perforation of the thin steel plate by the steel ball: every model, method and setting, beside Huang et al. 2010, Table II.

  validate_steel_ball.py                       M1 as a quarter, M1 to M3 axisymmetric: all runs not there yet, then the table
  validate_steel_ball.py --models 1 2 3        quarters of all three models too (hours)
  validate_steel_ball.py --methods huang_second --settings recommended
  validate_steel_ball.py --until 0.002         a trial: the table is printed, no document is touched

Runs examples/scenes/steel_ball with --set alone, one thread each. A run that has ended with the same settings, scene and
engine is not made again, so an interrupted sweep goes on where it was. Settings:
  paper        examples/settings/huang2010.toml
  recommended  the scene as it is
  axisymmetric axisymmetric.toml, whose numerics are the same: all three models, seconds each; M1 with every other method too
Shapes are measured as tools/measure_steel_ball.py does. Writes the part "steel-ball" of docs/validation.md and
docs/data/steel_ball.csv.
"""

import argparse
import csv
import os
import sys
import tomllib

from measure_steel_ball import EXPERIMENT, measure_run, read_table_ii
from plot_common import Refused, run_main
from plot_history import History, momentum_error
from validation_table import FLIP_ALONE, Case, digest, engine_of, last_run, markdown_table, numerics_text, replace_block, run_cases

TOP = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
SCENE = os.path.join("examples", "scenes", "steel_ball", "scene.toml")
METHODS = {"single_field": "standard", "huang_first": "first", "huang_second": "second"}
OTHERS = ["york", "hu_chen", "bardenhagen_2000", "bardenhagen_2001", "pan_2008", "persistent"]  # M1 axisymmetric, recommended
PAPER_FILE = os.path.join(TOP, "examples", "settings", "huang2010.toml")
SETTINGS = {"paper": ["@" + PAPER_FILE], "recommended": [], "axisymmetric": []}
AXISYMMETRIC = os.path.join("examples", "scenes", "steel_ball", "axisymmetric.toml")


class Row:
    """One run's numbers."""

    def __init__(self, model, method, settings, directory, outcome):
        self.model, self.method, self.settings, self.directory = model, method, settings, directory
        row = read_table_ii()[f"M{model}"]
        self.cell, self.spacing = row["cell_size"], row["spacing"]
        self.paper_speed, self.paper_shape = row.get(method + "_velocity"), row.get(method + "_h_over_d")
        self.failure = outcome.get("failure")
        summary = outcome.get("summary")
        if summary:
            measured, parameters = measure_run(directory)
            self.vr = summary["results"]["residual_velocity"]
            self.h, self.d, self.through = measured["h"], measured["D"], measured["through"]
            self.energy = 100 * summary["energy"]["residual_relative"]
            self.fastest = summary["maximum_speed_ever"] / parameters["V0"]
            # x and y are interchangeable in a quarter, and so the momenta along them.
            momenta = [summary["bodies"]["plate"]["momentum"][axis] + summary["bodies"]["ball"]["momentum"][axis]
                       for axis in (0, 1)]
            self.asymmetry = abs(momenta[0] - momenta[1]) / abs(summary["bodies"]["ball"]["mass"] * parameters["V0"])
            if settings == "axisymmetric":
                self.asymmetry = None
            self.momentum_error = momentum_error(History(directory))
            self.time, self.steps = 1000 * summary["time"], summary["steps"]
            self.wall, self.version = summary["wall_seconds"], summary["version"]

    def shape(self):
        """h/D, where there is a hole."""
        return self.h / self.d if self.through and self.d > 0 else None

    def cells(self):
        begin = [f"M{self.model}", METHODS.get(self.method, self.method)]
        paper = ["no" if self.paper_speed is None else f"{self.paper_speed:g}",
                 "–" if self.paper_shape is None else f"{self.paper_shape:g}"]
        if self.failure:
            return begin + ["broke down", "–", paper[0], "–", "–", "–", paper[1]] + ["–"] * 5
        return begin + ["yes" if self.through else "no", f"{self.vr:.1f}", paper[0], f"{self.h:.2f}", f"{self.d:.2f}",
                        "–" if self.shape() is None else f"{self.shape():.2f}", paper[1], f"{self.energy:+.2f}",
                        f"{self.fastest:.2f}", "–" if self.asymmetry is None else f"{self.asymmetry:.0e}",
                        f"{self.momentum_error:.0e}", f"{self.wall:.1f}"]


HEADING = ["model", "method", "through", "Vr m/s", "paper", "h mm", "D mm", "h/D", "paper", "energy residual %",
           "fastest particle / V0", "asymmetry", "momentum error", "wall s"]


def checks(rows):
    """What the project asks of these runs: (text, met or None where a run is missing)."""
    result = []
    for settings in ("paper", "recommended"):
        chosen = {row.method: row for row in rows if (row.settings, row.model) == (settings, 1)}
        contact = [chosen.get(method) for method in ("huang_first", "huang_second")]
        result.append((f"M1, {settings} settings: perforates with both contact methods",
                       None if None in contact else all(not row.failure and row.through for row in contact)))
        standard = chosen.get("single_field")
        result.append((f"M1, {settings} settings: does not perforate with the standard method",
                       None if standard is None else not standard.failure and not standard.through))
    recommended = [row for row in rows if (row.settings, row.method) == ("recommended", "huang_second")]
    result.append(("recommended settings, second method: total energy grows by 2 % at most",
                   all(not row.failure and row.energy <= 2 for row in recommended) if recommended else None))
    result.append(("standard, first and second method: none breaks down, no particle is ever faster than twice V0",
                   all(not row.failure and row.fastest <= 2 for row in rows if row.method in METHODS)))
    return result


def validation_text(rows):
    good = [row for row in rows if not row.failure]
    scene_file = os.path.join(TOP, SCENE)
    titles = {name: f"{title} ({numerics_text(scene_file, [*SETTINGS[name], 'contact.method=huang_second'])})"
              for name, title in (("paper", "Settings of the paper"), ("recommended", "Recommended settings"),
                                  ("axisymmetric", "Axisymmetric, recommended settings"))}
    parts = ["Made by `tools/validate_steel_ball.py` with Ogive " + ", ".join(sorted({row.version for row in good}))
             + " (one thread; the wall time is of a machine that did other work too), read at "
             + ", ".join(f"{time:.0f}" for time in sorted({round(row.time) for row in good}))
             + f" us. Experiment: h/D {EXPERIMENT}. *Asymmetry*: difference of the momenta along x and y, which should be "
             "equal, of the ball's initial momentum. *Momentum error*: momentum that neither faces nor clamps gave, of the largest. " + last_run(row.directory for row in good)]
    for settings, title in titles.items():
        chosen = [row for row in rows if row.settings == settings]
        if chosen:
            parts += [f"**{title}**", markdown_table(HEADING, [row.cells() for row in chosen])]
    words = {True: "met", False: "**not met**", None: "not run"}
    parts.append(markdown_table(["asked", "state"], [[text, words[state]] for text, state in checks(rows)]))
    return "\n\n".join(parts)


def write_csv(path, rows):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["settings", "model", "cell_size", "spacing", "method", "through", "residual_velocity",
                         "paper_velocity", "h", "d", "h_over_d", "paper_h_over_d", "experiment_h_over_d",
                         "energy_residual_relative", "fastest_over_v0", "asymmetry", "momentum_error", "time_us", "steps", "wall_seconds",
                         "version"])
        for row in rows:
            paper_speed = "" if row.paper_speed is None else f"{row.paper_speed:g}"
            paper_shape = "" if row.paper_shape is None else f"{row.paper_shape:g}"
            begin = [row.settings, f"M{row.model}", f"{row.cell:g}", f"{row.spacing:g}", row.method]
            if row.failure:
                writer.writerow(begin + ["broke down", "", paper_speed, "", "", "", paper_shape, EXPERIMENT] + [""] * 8)
                continue
            shape = "" if row.shape() is None else f"{row.shape():.4g}"
            writer.writerow(begin + [int(row.through), f"{row.vr:.6g}", paper_speed, f"{row.h:.6g}", f"{row.d:.6g}", shape,
                                     paper_shape, EXPERIMENT, f"{row.energy / 100:.4g}", f"{row.fastest:.4g}",
                                     "" if row.asymmetry is None else f"{row.asymmetry:.2g}", f"{row.momentum_error:.2g}", f"{row.time:.6g}", row.steps, f"{row.wall:.1f}", row.version])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=int, nargs="+", choices=[1, 2, 3], default=[1], metavar="M",
                        help="of 1, 2, 3, as quarters (default: 1)")
    parser.add_argument("--methods", nargs="+", choices=list(METHODS), default=list(METHODS), metavar="METHOD",
                        help="of " + ", ".join(METHODS))
    parser.add_argument("--settings", nargs="+", choices=list(SETTINGS), default=list(SETTINGS), metavar="SETTINGS",
                        help="of " + ", ".join(SETTINGS))
    parser.add_argument("--until", type=float, help="end time of all runs, ms: for trials, which touch no document")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="runs at once (default: processors)")
    parser.add_argument("--program", default=os.path.join(TOP, "build", "release", "bin", "ogive"))
    parser.add_argument("--output", help="directory of the runs (default out/validation/steel_ball)")
    parser.add_argument("--tables-only", action="store_true", help="no runs: the table of what is there")
    parser.add_argument("--gate", action="store_true", help="exit code 1 if something that is asked is not met")
    arguments = parser.parse_args()

    trial = arguments.until is not None
    output = arguments.output or os.path.join(TOP, "out", "validation", "steel_ball-trial" if trial else "steel_ball")
    scene_file = os.path.join(TOP, SCENE)
    with open(scene_file, "rb") as file:
        scene = tomllib.load(file)
    until = arguments.until or scene["stop"]["time"]
    engine = engine_of(arguments.program)
    axisymmetric_file = os.path.join(TOP, AXISYMMETRIC)
    identity = {"scene": digest(scene_file, PAPER_FILE), "engine": digest(engine)}
    axisymmetric_identity = {"scene": digest(axisymmetric_file), "engine": digest(engine)}

    cases = {}
    for settings in SETTINGS:
        for model in (1, 2, 3):
            for method in [*METHODS, *OTHERS] if (settings, model) == ("axisymmetric", 1) else METHODS:
                options = [f"parameters.model={model}", f"contact.method={method}", *SETTINGS[settings], *FLIP_ALONE.get(method, []),
                           f"output.particle_interval={until:g}", "output.checkpoint_steps=0"]
                words = [word for option in options for word in ("--set", option)] + ["--until", f"{until:g}"]
                cases[settings, model, method] = Case(os.path.join(output, settings, f"M{model}-{method}"), words,
                                                       axisymmetric_identity if settings == "axisymmetric" else identity)

    if not arguments.tables_only:
        for axisymmetric in (False, True):
            wanted = [case for (settings, model, method), case in cases.items() if settings in arguments.settings
                      and (settings == "axisymmetric") == axisymmetric and (axisymmetric or model in arguments.models)
                      and (method in arguments.methods or (method in OTHERS and arguments.methods == list(METHODS)))]
            run_cases(wanted, arguments.program, engine, axisymmetric_file if axisymmetric else scene_file, arguments.jobs)

    rows = []
    for (settings, model, method), case in cases.items():
        outcome = case.outcome()
        if outcome:
            rows.append(Row(model, method, settings, case.directory, outcome))
    if not any(not row.failure for row in rows):
        raise Refused(f"{output}: no runs of this engine and scene")
    text = validation_text(rows)
    print(f"\n{text}")
    if not trial:
        write_csv(os.path.join(TOP, "docs", "data", "steel_ball.csv"), rows)
        replace_block(os.path.join(TOP, "docs", "validation.md"), "steel-ball", text)
    if arguments.gate and not all(state for _, state in checks(rows)):
        sys.exit(1)


if __name__ == "__main__":
    run_main(main)
