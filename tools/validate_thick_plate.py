#!/usr/bin/python3
"""Perforation of the thick plate: every impact speed, method and setting, beside the paper and the experiment.

  validate_thick_plate.py                              all runs that are not there yet, then the tables
  validate_thick_plate.py --only 575 --methods huang_second
  validate_thick_plate.py --only 575 --until 0.002     a trial: the tables are printed, no document is touched

Runs examples/scenes/thick_plate with --set alone, several processes at once, one thread each. A run that has ended with
the same settings, scene, version and engine is not made again, so an interrupted sweep goes on where it was. Settings:
  paper        examples/settings/huang2010.toml
  literal      trilinear, factor 0.4, contact at any shared node, FLIP and the stress first, all as the paper has it; the
               second method alone
  recommended  the scene as it is; the standard method, whose rod and plate share one velocity field, with the stress last,
               2 % of the grid's own velocity a step and smaller steps
The other methods are run at 575 m/s with the paper's and the recommended settings.
Residual velocity is read when the rod's speed has settled by the scene's rule; for the standard method, which creeps, at
a stated time (--read-standard-at; default 0.25 ms). Writes the marked parts of docs/validation.md and README.md,
and docs/data/thick_plate.csv.
"""

import argparse
import csv
import os
import sys
import tomllib

from plot_common import Refused, run_main
from plot_history import History, momentum_error
from validation_table import (FLIP_ALONE, Case, digest, engine_of, last_run, markdown_table, numerics_text, read_references, replace_block,
                              run_cases)

TOP = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
SCENE = os.path.join("examples", "scenes", "thick_plate", "scene.toml")
METHODS = {"single_field": "standard", "huang_first": "first", "huang_second": "second"}
OTHERS = ["york", "hu_chen", "bardenhagen_2000", "bardenhagen_2001", "pan_2008", "persistent"]
OTHERS_AT = 575.0  # m/s
PAPER_FILE = os.path.join(TOP, "examples", "settings", "huang2010.toml")
SETTINGS = {
    "paper": ["@" + PAPER_FILE],
    "literal": ["numerics.shape_function=linear", "numerics.time_step_factor=0.4", "contact.detection=shared_node",
                "numerics.transfer=flip", "numerics.update_order=stress_first"],
    "recommended": [],
}
STANDARD_RECOMMENDED = ["numerics.update_order=stress_last", "numerics.pic_fraction=0.02", "numerics.time_step_factor=0.3"]
TITLES = {"paper": "Settings of the paper", "literal": "The paper's scheme to the letter", "recommended": "Recommended settings"}
BALLISTIC = 340.0  # near the ballistic limit Vr is ill-conditioned: the speed lost, in the sense of energy, is compared


def settings_of(settings, method):
    return SETTINGS[settings] + (STANDARD_RECOMMENDED if (settings, method) == ("recommended", "single_field") else [])


class Row:
    """One run's numbers."""

    def __init__(self, v0, method, settings, reference, directory, outcome):
        self.v0, self.method, self.settings, self.reference, self.directory = v0, method, settings, reference, directory
        self.paper, self.experiment = reference.get(method), reference["experiment"]
        self.failure = outcome.get("failure")
        summary = outcome.get("summary")
        if summary:
            self.vr = summary["results"]["residual_velocity"]
            self.energy = 100 * summary["energy"]["residual_relative"]
            self.transfer = 100 * summary["energy"]["transfer_dissipation"] / summary["energy"]["initial_total"]
            self.fastest = summary["maximum_speed_ever"] / v0
            self.momentum_error = momentum_error(History(directory))
            self.stop = summary["stop_reason"]
            self.time = 1000 * summary["time"]
            self.steps = summary["steps"]
            self.wall = summary["wall_seconds"]
            self.version = summary["version"]

    def against(self, reference):
        """Error in percent; none where the reference is 0."""
        return 100 * (self.vr / reference - 1) if reference else None

    def lost(self, speed):
        """Speed whose kinetic energy is what the target took."""
        return (self.v0**2 - speed**2) ** 0.5

    def lost_error(self):
        return 100 * (self.lost(self.vr) / self.lost(self.paper) - 1)

    def cells(self):
        begin = [f"{self.v0:g}", f"{self.experiment:g}", f"{self.paper:g}"]
        if self.failure:
            return begin + ["broke down"] + ["–"] * 10
        return begin + [f"{self.vr:.1f}", percent(self.against(self.paper)), percent(self.against(self.experiment)),
                        f"{self.lost_error():+.1f}", f"{self.energy:+.2f}", f"{self.transfer:.1f}",
                        f"{self.fastest:.2f}", f"{self.momentum_error:.0e}", self.stop, f"{self.time:.0f}", f"{self.wall:.0f}"]

    def other_cells(self):
        begin = [TITLES[self.settings].lower(), self.method]
        if self.failure:
            return begin + ["broke down"] + ["–"] * 8
        return begin + [f"{self.vr:.1f}", percent(self.against(self.experiment)), f"{self.energy:+.2f}", f"{self.transfer:.1f}",
                        f"{self.fastest:.2f}", f"{self.momentum_error:.0e}", self.stop, f"{self.time:.0f}", f"{self.wall:.0f}"]


HEADING = ["V0 m/s", "experiment", "paper", "Vr", "against paper %", "against experiment %", "V lost against paper %",
           "energy residual %", "transfer %", "fastest particle / V0", "momentum error", "stopped", "time us", "wall s"]
OTHER_HEADING = ["settings", "method", "Vr", "against experiment %", "energy residual %", "transfer %",
                 "fastest particle / V0", "momentum error", "stopped", "time us", "wall s"]


def percent(value):
    return "–" if value is None else f"{value:+.1f}"


def checks(rows):
    """What the project asks of these runs: (text, met or None where a run is missing)."""
    found = {(row.settings, row.method, row.v0): row for row in rows}
    speeds = sorted({row.v0 for row in rows})

    def each(settings, method, test, chosen=speeds):
        rows_of = [found.get((settings, method, v0)) for v0 in chosen]
        if not rows_of or None in rows_of:
            return None
        return all(not row.failure and test(row) for row in rows_of)

    above = [v0 for v0 in speeds if v0 > BALLISTIC]
    result = [
        ("paper's settings, second method: Vr within 2.5 % of the paper above 340 m/s",
         each("paper", "huang_second", lambda row: abs(row.against(row.paper)) <= 2.5, above)),
        ("paper's settings, second method, 340 m/s: sqrt(V0² − Vr²) within 2 % of the paper's",
         each("paper", "huang_second", lambda row: abs(row.lost_error()) <= 2, [BALLISTIC])),
        ("paper's settings, first method: Vr within 5 % of the paper above 340 m/s",
         each("paper", "huang_first", lambda row: abs(row.against(row.paper)) <= 5, above)),
        ("paper's settings, standard method: Vr below that of the second by more than 10 % of V0",
         each("paper", "single_field",
              lambda row: (other := found.get(("paper", "huang_second", row.v0))) and not other.failure
              and row.vr < other.vr - 0.1 * row.v0, above)),
    ] + [
        (f"recommended settings, {name} method: total energy grows by 2 % at most",
         each("recommended", method, lambda row: row.energy <= 2)) for method, name in METHODS.items()
    ]
    if rows:
        for settings in ("paper", "recommended"):
            chosen = [row for row in rows if row.settings == settings and row.method in METHODS]
            result.append((f"{TITLES[settings].lower()}: none breaks down, no particle is ever faster than twice V0",
                           all(not row.failure and row.fastest <= 2 for row in chosen) if chosen else None))
    return result


def validation_text(rows, scene, read_at, whole):
    parts = []
    stop = scene["stop"]
    rule = ("All runs go on to the time that is stated." if whole else
            f"Residual velocity is read when the rod's speed has changed by less than {stop['settle_tolerance']:g} m/s in "
            f"{1000 * stop['settle_window']:g} us.")
    parts.append(
        "Made by `tools/validate_thick_plate.py` with Ogive " + ", ".join(sorted({r.version for r in rows if not r.failure}))
        + " (one thread; the wall time is of a machine that did other work too). Scene: "
        "`examples/scenes/thick_plate`, friction 0. " + rule + f" The standard method creeps and is read at "
        f"{1000 * read_at:g} us. *Energy residual*: what no term of the energy ledger accounts for, of the initial total "
        "energy; *momentum error*: momentum that nothing gave, of the largest; *transfer*: what affine velocities took (booked, no part of the residual). *V lost*: sqrt(V0² − Vr²), the speed whose energy the target took; near the ballistic limit (340 m/s) it "
        "is the meaningful comparison, because Vr there magnifies any small difference. " + last_run(row.directory for row in rows))
    for settings in SETTINGS:
        for method, name in METHODS.items():
            chosen = [row for row in rows if (row.settings, row.method) == (settings, method)]
            if chosen:
                parts.append(f"**{TITLES[settings]}, {name} method** ("
                             + numerics_text(os.path.join(TOP, SCENE), [f"contact.method={method}", *settings_of(settings, method)])
                             + ")")
                parts.append(markdown_table(HEADING, [row.cells() for row in chosen]))
    others = [row for row in rows if row.method in OTHERS]
    if others:
        parts.append(f"**Other methods at {OTHERS_AT:g} m/s** (York's, Hu and Chen's and Pan's with FLIP)")
        parts.append(markdown_table(OTHER_HEADING, [row.other_cells() for row in others]))
    words = {True: "met", False: "**not met**", None: "not run"}
    parts.append(markdown_table(["asked", "state"], [[text, words[state]] for text, state in checks(rows)]))
    return "\n\n".join(parts)


def readme_text(rows):
    """The second method beside paper and experiment."""
    found = {(row.settings, row.v0): row for row in rows if row.method == "huang_second" and not row.failure}
    standard = {row.v0: row for row in rows if (row.settings, row.method) == ("paper", "single_field") and not row.failure}

    def speed(row):
        return f"{row.vr:.1f}" if row else "–"

    def energy(row):
        return f"{row.energy:+.1f}" if row else "–"

    lines = []
    for v0 in sorted({row.v0 for row in rows}):
        paper, recommended = found.get(("paper", v0)), found.get(("recommended", v0))
        reference = next(row.reference for row in rows if row.v0 == v0)
        lines.append([f"{v0:g}", f"{reference['experiment']:g}", f"{reference['huang_second']:g}", speed(paper),
                      energy(paper), speed(recommended), energy(recommended), f"{reference['single_field']:g}",
                      speed(standard.get(v0))])
    return markdown_table(["V0 m/s", "experiment", "paper, second method", "Ogive, paper's settings", "energy %",
                           "Ogive, recommended", "energy %", "paper, standard MPM", "Ogive, standard MPM"], lines)


def write_csv(path, rows):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["settings", "method", "v0", "experiment", "paper", "residual_velocity", "energy_residual_relative",
                         "transfer_relative", "fastest_over_v0", "momentum_error", "stop_reason", "time_us", "steps", "wall_seconds", "version"])
        for row in rows:
            begin = [row.settings, row.method, f"{row.v0:g}", row.experiment, "" if row.paper is None else row.paper]
            writer.writerow(begin + (["", "", "", "", "", "broke down", "", "", "", ""] if row.failure else
                                     [f"{row.vr:.6g}", f"{row.energy / 100:.4g}", f"{row.transfer / 100:.4g}",
                                      f"{row.fastest:.4g}", f"{row.momentum_error:.2g}", row.stop,
                                      f"{row.time:.6g}", row.steps, f"{row.wall:.1f}", row.version]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", type=float, nargs="+", metavar="V0", help="these impact speeds alone are run")
    parser.add_argument("--methods", nargs="+", choices=list(METHODS), default=list(METHODS), metavar="METHOD",
                        help="of " + ", ".join(METHODS))
    parser.add_argument("--settings", nargs="+", choices=list(SETTINGS), default=list(SETTINGS), metavar="SETTINGS",
                        help="of " + ", ".join(SETTINGS))
    parser.add_argument("--until", type=float, help="end time of all runs, ms: for trials, which touch no document")
    parser.add_argument("--read-standard-at", type=float, metavar="MS", default=0.25,
                        help="when the standard method is read, ms (default 0.25)")
    parser.add_argument("--whole", action="store_true", help="no run ends when the rod has settled: all go to stop.time")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="runs at once (default: processors)")
    parser.add_argument("--program", default=os.path.join(TOP, "build", "release", "bin", "ogive"))
    parser.add_argument("--output", help="directory of the runs (default out/validation/thick_plate)")
    parser.add_argument("--tables-only", action="store_true", help="no runs: tables of what is there")
    parser.add_argument("--gate", action="store_true", help="exit code 1 if something that is asked is not met")
    arguments = parser.parse_args()

    trial = arguments.until is not None
    output = arguments.output or os.path.join(TOP, "out", "validation", "thick_plate-trial" if trial else "thick_plate")
    references = read_references(os.path.join(TOP, "tests", "data", "huang2010_thick_plate.csv"))
    for v0 in arguments.only or []:
        if v0 not in references:
            raise Refused(f"--only {v0:g}: expected some of " + ", ".join(f"{known:g}" for known in references))
    scene_file = os.path.join(TOP, SCENE)
    with open(scene_file, "rb") as file:
        scene = tomllib.load(file)
    read_at = arguments.until or arguments.read_standard_at
    engine = engine_of(arguments.program)
    identity = {"scene": digest(scene_file, os.path.join(os.path.dirname(scene_file), "rod.stl"), PAPER_FILE),
                "engine": digest(engine)}

    cases = {}
    for settings in SETTINGS:
        for method in [*METHODS, *OTHERS] if settings != "literal" else ["huang_second"]:
            for v0 in references if method in METHODS else [OTHERS_AT]:
                options = [f"parameters.V0={v0:g}", f"contact.method={method}", *settings_of(settings, method),
                           *FLIP_ALONE.get(method, []), "output.particle_interval=0", "output.checkpoint_steps=0"]
                if method == "single_field" or arguments.whole:
                    options.append("stop.settle_window=0")
                words = [word for option in options for word in ("--set", option)]
                if trial or method == "single_field" or method in OTHERS:
                    words += ["--until", f"{read_at:g}"]
                cases[settings, method, v0] = Case(os.path.join(output, settings, f"{method}-{v0:g}"), words, identity)

    if not arguments.tables_only:
        wanted = [case for (settings, method, v0), case in cases.items()
                  if settings in arguments.settings
                  and (method in arguments.methods or (method in OTHERS and arguments.methods == list(METHODS)))
                  and v0 in (arguments.only or references)]
        run_cases(wanted, arguments.program, engine, scene_file, arguments.jobs)

    outcomes = {key: case.outcome() for key, case in cases.items()}
    rows = [Row(v0, method, settings, references[v0], cases[settings, method, v0].directory, outcome)
            for (settings, method, v0), outcome in outcomes.items() if outcome]
    if not rows:
        raise Refused(f"{output}: no runs of this engine and scene")
    text = validation_text(rows, scene, read_at, arguments.whole)
    print(f"\n{text}\n\n{readme_text(rows)}")
    if not trial:
        write_csv(os.path.join(TOP, "docs", "data", "thick_plate.csv"), rows)
        replace_block(os.path.join(TOP, "docs", "validation.md"), "thick-plate", text)
        replace_block(os.path.join(TOP, "README.md"), "thick-plate-results", readme_text(rows))
    if arguments.gate and not all(state for _, state in checks(rows)):
        sys.exit(1)


if __name__ == "__main__":
    run_main(main)
