#!/usr/bin/python3
"""Contact methods on the papers' cases and on measured copper bars: one table and one plot a scene.

  validate_contact.py                          the fast part: all runs that are not there yet, tables, plots
  validate_contact.py --full                   the full part too: finer cells (an hour)
  validate_contact.py --check                  the fast part (CI): no document is touched; exit code 1 if something is not
                                               met that must be (the tests run this)
  validate_contact.py --scenes rings --methods huang_second
                                               a trial: the tables are printed, no document is touched

Runs examples/scenes/* with --set alone, several processes at once, one thread each. A run that has ended with the same
settings, scene and engine is not made again. Settings:
  recommended  the scene as it is; York's, Hu and Chen's and Pan's methods with FLIP
  letter       what the papers print: trilinear functions, FLIP, stress first, contact at any shared node
  trilinear    (rings) trilinear functions and FLIP with the stress last and the gap criterion, 0.5 cells
Writes docs/data/contact/<scene>.csv, docs/images/<scene>.png and the parts "<scene>" of docs/validation.md; the full part
goes to "<scene>-full" with the date and the machine, and stays as it is when the fast part alone runs.
"""

import argparse
import csv
import os

import numpy as np

from measure_steel_ball import largest_connected
from plot_common import Refused, plt, run_main
from plot_history import History, momentum_error
from plot_section import open_particles, particle_files
from validation_table import FLIP_ALONE, Case, digest, engine_of, last_run, markdown_table, read_rows, replace_block, run_cases

TOP = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
DATA = os.path.join(TOP, "tests", "data")
METHODS = ["single_field", "york", "hu_chen", "bardenhagen_2000", "bardenhagen_2001", "pan_2008", "huang_first",
           "huang_second", "persistent"]
DEFAULT = "persistent"
SETTINGS = {
    "recommended": [],
    "letter": ["numerics.shape_function=linear", "numerics.transfer=flip", "numerics.update_order=stress_first",
               "contact.detection=shared_node"],
    "trilinear": ["numerics.shape_function=linear", "numerics.transfer=flip", "numerics.update_order=stress_last",
                  "contact.gap_offset=0.5"],
}
PLOTTED = ["recommended", "letter"]


class Run:
    """One row of a table: its labels, in the columns' order, and what --set gets."""

    def __init__(self, labels, options, full=False):
        self.labels, self.options, self.full = labels, options, full

    @property
    def name(self):
        return "-".join(str(value) for value in self.labels.values())


def grid_runs(settings, methods=METHODS, full=False, labels=None, options=()):
    """A run for each of the methods with these settings."""
    return [Run({"settings": settings, **(labels or {}), "method": method},
                [*SETTINGS[settings], *FLIP_ALONE.get(method, []), f"contact.method={method}", *options], full)
            for method in methods]


class Column:
    """What stands in a table: key of the measured value, heading, format, factor from the CSV's value to the table's."""

    def __init__(self, key, heading, form=".3g", factor=1):
        self.key, self.heading, self.form, self.factor = key, heading, form, factor

    def text(self, measured):
        value = measured.get(self.key)
        if value is None:
            return "–"
        if isinstance(value, str):
            return value
        return format(value if self.factor == 1 else value * self.factor, self.form)


# What every run tells: the largest change of the total energy at any time, of the largest energy that the bodies had (a scene
# under gravity begins with none); what the ledger books as heat of friction and as lost in the transfer; momentum that
# nothing accounts for, of the largest sum of the bodies' momenta or the largest impulse.
COMMON = [Column("energy", "energy change %", "+.2f", 100), Column("friction", "friction %", ".1f", 100),
          Column("transfer", "transfer %", ".1f", 100),
          Column("momentum_error", "momentum error", ".0e"), Column("steps", "steps", "d"),
          Column("wall_seconds", "wall s", ".1f")]


def common_measures(history, summary):
    mechanical = history["kinetic"] + history["internal"]
    scale = max(mechanical.max(), abs(summary["energy"]["initial_total"]))
    residual = history["residual"]
    return {"energy": residual[np.abs(residual).argmax()] / scale,
            "friction": history["friction_dissipation"][-1] / scale,
            "transfer": history["transfer_dissipation"][-1] / scale,
            "momentum_error": momentum_error(history),
            "steps": summary["steps"], "wall_seconds": summary["wall_seconds"], "version": summary["version"]}


class Scene:
    """One scene: its runs, what is measured in each, its table and its plot."""

    columns = []

    @property
    def file(self):
        return os.path.join(TOP, "examples", "scenes", self.name, "scene.toml")

    def checks(self, rows):
        """What the project asks, as Asked."""
        return []


class Asked:
    """What is asked of some rows: all must meet the condition; a run that broke down does not. With gate=False a failure is
    known and explained in docs/validation.md."""

    def __init__(self, rows, text, condition, gate=True):
        self.rows, self.text, self.condition, self.gate = rows, text, condition, gate

    def state(self):
        """None: not run."""
        if not self.rows:
            return None
        return all(not row.failure and bool(self.condition(row.measured)) for row in self.rows)


def chosen(rows, **labels):
    """Rows, or runs, with these labels."""
    return [row for row in rows if all(getattr(row, "run", row).labels.get(key) == value for key, value in labels.items())]


def within(case, quantity):
    """The condition that a number lies in the band of tests/data/contact_cases.csv."""
    rows = read_rows(os.path.join(DATA, "contact_cases.csv"))
    band = next(row for row in rows if (row["case"], row["quantity"]) == (case, quantity))
    lower, upper = float(band["from"]), float(band["to"])
    return lambda value: value is not None and lower <= value <= upper


def momentum_kept(rows):
    return Asked([row for row in rows if not row.failure], "momentum is kept to round-off (1e-10) in every run",
                 lambda m: m["momentum_error"] <= 1e-10)


class Rings(Scene):
    name = "rings"
    compared = ["huang_first", "huang_second", DEFAULT]
    columns = [Column("whole", "whole"), Column("last_contact", "last contact ms", ".2f"),
               Column("rebound", "rebound m/s", ".1f")]

    def runs(self):
        runs = grid_runs("recommended", labels={"alpha": 0.25}) + grid_runs("letter", labels={"alpha": 0.25})
        runs += grid_runs("trilinear", self.compared, labels={"alpha": 0.25})
        for alpha in (0.5, 0.8, 1.0):
            for settings in SETTINGS:
                runs += grid_runs(settings, self.compared, labels={"alpha": alpha},
                                  options=[f"numerics.time_step_factor={alpha}"])
        fine = ["grid.cell_size=1"] + [f"bodies.{body}.spacing=[0.5, 0.4434, 0.5]" for body in ("left", "right")]
        for settings in ("recommended", "trilinear"):
            runs += grid_runs(settings, [DEFAULT], True, {"alpha": "0.25, cell 1 mm"}, fine)
        return runs

    def measure(self, run, directory, history, summary):
        force = np.abs(history["left.contact_force_x"])
        touching = np.flatnonzero(force > 1e-6 * force.max())
        with open_particles(particle_files([directory])[-1]) as file:
            whole = all(largest_connected(file[body]["position"][()], 2.0).all() for body in ("left", "right"))
        apart = np.flatnonzero(history["right.velocity_x"] > history["left.velocity_x"])
        return {"whole": "yes" if whole and summary["left_domain_mass"] == 0 else "no",
                "last_contact": history["time"][touching[-1]] if len(touching) else None,
                "rebound": history["right.velocity_x"][-1] if len(apart) else 0.0}

    def checks(self, rows):
        default = chosen(rows, settings="recommended", method=DEFAULT, alpha=0.25)
        trilinear = chosen(rows, settings="trilinear", method="huang_second", alpha=0.25)
        energy, last = within(self.name, "energy_change"), within(self.name, "last_contact_ms")
        return [Asked(default, "default method and settings at 0.25: rings whole, energy changes by less than 2 %",
                      lambda m: m["whole"] == "yes" and energy(m["energy"])),
                Asked(default, "the same: last contact at 3.4 to 3.6 ms", lambda m: last(m["last_contact"]), gate=False),
                Asked(default, "the same: last contact as finite elements have it, 3.0 to 3.25 ms",
                      lambda m: within(self.name, "last_contact_elements")(m["last_contact"])),
                Asked(trilinear, "trilinear functions with the gap criterion: whole, below 2 %, last contact at 3.4 to 3.6 ms",
                      lambda m: m["whole"] == "yes" and energy(m["energy"]) and last(m["last_contact"]))]

    def plot(self, figure, rows):
        panels = figure.subplots(1, 2, sharey=True)
        for panel, settings in zip(panels, PLOTTED):
            for row in rows:
                labels = row.run.labels
                if labels["settings"] == settings and labels["method"] in self.compared and not row.failure:
                    panel.plot(row.history["time"], 100 * row.history["residual_relative"],
                               label=f"{labels['method'].removeprefix('huang_')}, {labels['alpha']}",
                               linestyle={"huang_first": "--", "huang_second": ":"}.get(labels["method"], "-"))
            panel.set(xlabel="time [ms]", ylim=(-30, 60), title=settings)
            panel.legend(title="method, time-step factor", fontsize=7)
        panels[0].set(ylabel="change of total energy [%]")


class Rolling(Scene):
    """Sphere or cylinder on an incline: distance down the slope against that of a rigid body."""

    columns = [Column("distance", "distance m", ".3f"), Column("exact", "exact", ".3f"),
               Column("error", "error %", "+.1f", 100)]

    def measure(self, run, directory, history, summary):
        parameters = summary["parameters"]
        # tan th > (1 + m R^2 / I) mu slips; 5/2 of a sphere, 2 of a cylinder.
        ratio = {"sphere": 2.5, "cylinder": 2.0}[self.body]
        angle = np.radians(parameters["angle"])
        slips = np.tan(angle) > (1 + ratio) * parameters["friction"]
        acceleration = parameters["gravity"] * (np.sin(angle) - parameters["friction"] * np.cos(angle) if slips else
                                                np.sin(angle) * ratio / (1 + ratio))
        distance = history[f"{self.body}.centre_x"] - history[f"{self.body}.centre_x"][0]
        exact = 0.5 * acceleration * history["time"][-1] ** 2
        return {"distance": distance[-1], "exact": exact, "error": distance[-1] / exact - 1, "acceleration": acceleration}

    def plot(self, figure, rows):
        panels = figure.subplots(1, len(self.cases), sharey=True)
        for panel, case in zip(panels, self.cases):
            for row in chosen(rows, case=case, settings="recommended", cell=self.plotted_cell):
                if not row.failure:
                    panel.plot(row.history["time"], row.history[f"{self.body}.centre_x"], label=row.run.labels["method"])
            for row in chosen(rows, case=case)[:1]:
                time = row.history["time"]
                panel.plot(time, 0.5 * row.measured["acceleration"] * time ** 2, "k--", label="rigid, exact")
            panel.set(xlabel="time [s]", title=case)
        panels[0].set(ylabel="distance [m]")
        panels[0].legend(fontsize=7)


class RollingSphere(Rolling):
    name, body, plotted_cell = "rolling_sphere", "sphere", 0.2
    cases = {"stick": 0, "slip": 1}

    def runs(self):
        runs = []
        for case, slip in self.cases.items():
            option = f"parameters.slip={slip}"
            runs += grid_runs("recommended", labels={"case": case, "cell": 0.2}, options=[option])
            runs += grid_runs("letter", ["huang_first", "huang_second", DEFAULT], labels={"case": case, "cell": 0.2},
                              options=[option])
            runs += grid_runs("recommended", [DEFAULT], labels={"case": case, "cell": 0.4},
                              options=[option, "parameters.cell=0.4"])
            runs += grid_runs("recommended", [DEFAULT], True, {"case": case, "cell": 0.1},
                              [option, "parameters.cell=0.1"])
        # Nearer to the rigid sphere of the exact solution: both bodies ten times stiffer.
        stiff = [f"materials.{body}.elastic.{modulus}={value}" for body, modulus, value in
                 (("soft", "bulk_modulus", 70e6), ("soft", "shear_modulus", 15e6), ("stiff", "bulk_modulus", 700e6),
                  ("stiff", "shear_modulus", 150e6))]
        for cell in (0.4, 0.2):
            runs += grid_runs("recommended", [DEFAULT], labels={"case": "stick, stiffer", "cell": cell},
                              options=[*stiff, f"parameters.cell={cell}"])
        return runs

    def checks(self, rows):
        default = chosen(rows, settings="recommended", method=DEFAULT)
        fine, coarse = (chosen(default, case="stick, stiffer", cell=cell) for cell in (0.2, 0.4))
        return [Asked(chosen(default, case="slip", cell=0.2), "default method, slip, 0.2 m: error of 1 % at most",
                      lambda m: within(self.name, "slip_error")(m["error"])),
                Asked(chosen(default, case="stick", cell=0.2), "default method, stick, 0.2 m: error of 2 % at most",
                      lambda m: within(self.name, "stick_error")(m["error"])),
                Asked(fine + coarse, "stick, bodies ten times stiffer: the error falls by half at least from 0.4 to 0.2 m",
                      lambda m: abs(fine[0].measured["error"]) < 0.5 * abs(coarse[0].measured["error"])),
                Asked([row for row in chosen(rows, settings="letter", case="stick") if getattr(row, "run", row).labels["method"] != DEFAULT],
                      "Huang's methods to the letter, stick: 6 % at most",
                      lambda m: within(self.name, "stick_error_letter")(m["error"]))]


class RollingCylinder(Rolling):
    name, body, plotted_cell = "rolling_cylinder", "cylinder", 0.4
    cases = {"30 deg, 0.3": (30, 0.3), "45 deg, 0.3": (45, 0.3), "60 deg, 0.3": (60, 0.3), "45 deg, 0.1": (45, 0.1),
             "45 deg, 0.6": (45, 0.6)}
    compared = ["bardenhagen_2001", "pan_2008", "huang_second", DEFAULT]

    def runs(self):
        runs = []
        for case, (angle, friction) in self.cases.items():
            options = [f"parameters.angle={angle}", f"parameters.friction={friction}"]
            for cell, full in ((0.4, False), (0.2, False), (0.1, True)):
                methods = METHODS if case in ("30 deg, 0.3", "60 deg, 0.3") and cell == 0.4 else self.compared
                runs += grid_runs("recommended", methods, full, {"case": case, "cell": cell},
                                  [*options, f"parameters.cell={cell}"])
            runs += grid_runs("letter", self.compared, labels={"case": case, "cell": 0.4}, options=options)
        return runs

    def checks(self, rows):
        default = chosen(rows, settings="recommended", method=DEFAULT, cell=0.2)
        return [Asked(default, "default method, 0.2 m: error of 6 % at most",
                      lambda m: within(self.name, "error")(m["error"]))]


class TwoSpheres(Scene):
    name = "two_spheres"
    columns = [Column("second_momentum", "momentum of the second %", ".1f", 100),
               Column("second_kinetic", "kinetic energy of the second %", ".1f", 100),
               Column("internal", "internal energy %", ".1f", 100), Column("contact_time", "contact time", ".1f")]

    def runs(self):
        runs = grid_runs("recommended", labels={"cell": 1}) + grid_runs("letter", labels={"cell": 1})
        runs += grid_runs("recommended", [DEFAULT], labels={"cell": 0.5}, options=["parameters.cell=0.5"])
        runs += grid_runs("recommended", [DEFAULT], True, {"cell": 0.25}, ["parameters.cell=0.25"])
        return runs

    def measure(self, run, directory, history, summary):
        force = np.abs(history["first.contact_force_x"])
        touching = history["time"][force > 0.01 * force.max()] if force.max() > 0 else []
        incoming = history["first.momentum_x"][0]
        return {"second_momentum": history["second.momentum_x"][-1] / incoming,
                "second_kinetic": history["second.kinetic"][-1] / history["kinetic"][0],
                "internal": history["internal"][-1] / history["kinetic"][0],
                "contact_time": touching[-1] - touching[0] if len(touching) else None}

    def checks(self, rows):
        default = chosen(rows, settings="recommended", method=DEFAULT, cell=1)
        return [Asked(default, "default method: 90 % of the momentum at least on the second sphere",
                      lambda m: within(self.name, "second_momentum")(m["second_momentum"])),
                Asked(default, "default method: total energy changes by less than 2 %",
                      lambda m: within(self.name, "energy_change")(m["energy"]))]

    def plot(self, figure, rows):
        panels = figure.subplots(1, 2, sharey=True)
        for panel, settings in zip(panels, PLOTTED):
            for row in chosen(rows, settings=settings, cell=1):
                if not row.failure:
                    speed = row.history["second.velocity_x"]
                    panel.plot(row.history["time"], speed / row.history["first.velocity_x"][0],
                               label=row.run.labels["method"])
            panel.set(xlabel="time", title=settings)
        panels[0].set(ylabel="velocity of the second / V0")
        panels[0].legend(fontsize=7)


class TaylorCopper(Scene):
    name = "taylor_copper"
    columns = [Column("length", "final length mm", ".2f"), Column("reference_length", "reference"),
               Column("foot", "foot radius mm", ".2f"), Column("reference_foot", "reference"),
               Column("at_fifth", "radius at 0.2 L mm", ".2f"), Column("reference_at_fifth", "reference"),
               Column("length_error", "length %", "+.1f", 100), Column("foot_error", "foot %", "+.1f", 100),
               Column("at_fifth_error", "at 0.2 L %", "+.1f", 100)]

    def runs(self):
        references = read_rows(os.path.join(DATA, "copper_taylor.csv"))
        runs = []
        for number, reference in enumerate(references):
            options = [f"parameters.bar={number}", f"bodies.bar.material={reference['material']}"]
            for cell in (0.4, 0.2):
                runs.append(Run({"settings": "recommended", "bar": reference["bar"], "cell": cell},
                                [*options, f"parameters.cell={cell}"], cell == 0.2))
            if number == 0:
                runs.append(Run({"settings": "letter", "bar": reference["bar"], "cell": 0.4},
                                [*SETTINGS["letter"], *options]))
        return runs

    def measure(self, run, directory, history, summary):
        references = read_rows(os.path.join(DATA, "copper_taylor.csv"))
        reference = next(row for row in references if row["bar"] == run.labels["bar"])
        shape = measure_bar(directory, summary["parameters"])
        result = dict(shape)
        for key in shape:
            lower, upper = float(reference[f"{key}_from"] or "nan"), float(reference[f"{key}_to"] or "nan")
            if not np.isnan(lower):
                result[f"reference_{key}"] = f"{lower:g}" if lower == upper else f"{lower:g} to {upper:g}"
                # Distance to the band, of its middle.
                result[f"{key}_error"] = (shape[key] - min(max(shape[key], lower), upper)) / (0.5 * (lower + upper))
        return result

    def checks(self, rows):
        benchmark = chosen(rows, settings="recommended", bar="benchmark", cell=0.4)
        return [Asked(benchmark, "benchmark: final length and foot within 2 % of the reference",
                      lambda m: all(within(self.name, "benchmark_error")(m[key]) for key in ("length_error", "foot_error")))]

    def plot(self, figure, rows):
        bars = chosen(rows, settings="recommended", cell=0.4)
        panels = figure.subplots(1, max(len(bars), 1), squeeze=False)[0]
        for panel, row in zip(panels, bars):
            with open_particles(particle_files([row.directory])[-1]) as file:
                x, y, z = file["bar"]["position"][()].T
            panel.plot(np.hypot(x, y), z, ",", color="#b87333")
            panel.set(title=row.run.labels["bar"], xlabel="radius [mm]", aspect="equal")
        panels[0].set(ylabel="distance from the wall [mm]")


def measure_bar(directory, parameters):
    """Length of the bar, radius of its foot and largest radius at 0.2 of the present length. The particles are layers of
    rings; half a ring lies outside the outermost, and is taken to have stretched along the radius as what lies between the two
    outermost has."""
    files = particle_files([directory])
    with open_particles(files[0]) as first, open_particles(files[-1]) as last:
        start, end = first["bar"]["position"][()], last["bar"]["position"][()]
    start_radius, radius = np.hypot(start[:, 0], start[:, 1]), np.hypot(end[:, 0], end[:, 1])
    layers, layer = np.unique(np.round(start[:, 2], 9), return_inverse=True)
    rings = np.unique(np.round(start_radius, 9))[-2:]
    inner, outer = (np.abs(start_radius - ring) < 1e-6 for ring in rings)
    surface, height = np.empty(len(layers)), np.empty(len(layers))
    for number in range(len(layers)):
        here = layer == number
        surface[number] = 1.5 * radius[here & outer].max() - 0.5 * radius[here & inner].max()
        height[number] = end[here & outer, 2].mean()
    # The far end is not compressed: half a layer lies beyond the last particles.
    length = end[:, 2].max() + parameters["length"] - start[:, 2].max()
    return {"length": length, "foot": surface[0], "at_fifth": np.interp(0.2 * length, height, surface)}


class FourSpheres(Scene):
    name = "four_spheres"
    columns = [Column("striker", "striker m/s", "+.1f"), Column("three", "the three m/s", ".1f"),
               Column("spread", "their difference %", ".2f", 100)]

    def runs(self):
        return (grid_runs("recommended", labels={"cell": 2}) + grid_runs("letter", labels={"cell": 2})
                + grid_runs("recommended", [DEFAULT, "pan_2008"], True, {"cell": 1}, ["parameters.cell=1"]))

    def measure(self, run, directory, history, summary):
        speeds = [history[f"{body}.speed"][-1] for body in ("first", "second", "third")]
        return {"striker": -history["striker.velocity_z"][-1], "three": np.mean(speeds),
                "spread": (max(speeds) - min(speeds)) / np.mean(speeds)}

    def checks(self, rows):
        pan = chosen(rows, settings="recommended", method="pan_2008", cell=2)
        default = chosen(rows, settings="recommended", method=DEFAULT, cell=2)
        energy = within(self.name, "energy_change")
        return [Asked(pan, "Pan's method: total energy changes by less than 2 %", lambda m: energy(m["energy"])),
                Asked(default, "default method: the same", lambda m: energy(m["energy"]))]

    def plot(self, figure, rows):
        panels = figure.subplots(1, 2, sharey=True)
        for panel, settings in zip(panels, PLOTTED):
            for row in chosen(rows, settings=settings, cell=2):
                if not row.failure:
                    panel.plot(1000 * row.history["time"], 100 * row.history["residual_relative"],
                               label=row.run.labels["method"])
            panel.set(xlabel="time [us]", title=settings, ylim=(-20, 20))
        panels[0].set(ylabel="change of total energy [%]")
        panels[0].legend(fontsize=7)


SCENES = {scene.name: scene for scene in
          (Rings(), RollingSphere(), RollingCylinder(), TwoSpheres(), TaylorCopper(), FourSpheres())}


class Row:
    """A run that has ended, and what was measured in it."""

    def __init__(self, scene, run, case):
        outcome = case.outcome()
        self.run, self.directory, self.failure = run, case.directory, outcome.get("failure")
        self.history = History(case.directory)
        self.measured = {}
        if not self.failure:
            summary = outcome["summary"]
            self.measured = {**scene.measure(run, case.directory, self.history, summary),
                             **common_measures(self.history, summary)}

    def cells(self, scene):
        labels = [str(value) for value in self.run.labels.values()]
        if self.failure:
            return labels + ["broke down"] + ["–"] * (len(scene.columns) + len(COMMON) - 1)
        return labels + [column.text(self.measured) for column in scene.columns + COMMON]


def table_text(scene, rows, checks):
    heading = list(rows[0].run.labels) + [column.heading for column in scene.columns + COMMON]
    text = markdown_table(heading, [row.cells(scene) for row in rows])
    if checks:
        words = {True: "met", False: "**not met**", None: "not run"}
        text += "\n\n" + markdown_table(["asked", "state"], [[check.text, words[check.state()]] for check in checks])
    return text


def write_csv(path, scene, rows):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    labels = list(rows[0].run.labels)
    keys = [column.key for column in scene.columns + COMMON] + ["version"]
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(labels + keys)
        for row in rows:
            values = [row.measured.get(key, "") for key in keys]
            writer.writerow([row.run.labels[label] for label in labels]
                            + [f"{value:.6g}" if isinstance(value, float) else value for value in values])


def write_plot(path, scene, rows):
    figure = plt.figure(figsize=(8, 3.2), layout="constrained")
    scene.plot(figure, rows)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=list(SCENES), default=list(SCENES), metavar="SCENE",
                        help="of " + ", ".join(SCENES))
    parser.add_argument("--methods", nargs="+", choices=METHODS, metavar="METHOD",
                        help="these alone, as a trial: of " + ", ".join(METHODS))
    parser.add_argument("--full", action="store_true", help="the full part too")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="runs at once (default: processors)")
    parser.add_argument("--program", default=os.path.join(TOP, "build", "release", "bin", "ogive"))
    parser.add_argument("--output", default=os.path.join(TOP, "out", "validation"), help="directory of the runs")
    parser.add_argument("--tables-only", action="store_true", help="no runs: tables of what is there")
    parser.add_argument("--check", action="store_true", help="no document is touched; exit code 1 if what is asked is not met")
    arguments = parser.parse_args()
    engine = engine_of(arguments.program)
    trial = arguments.methods or arguments.check
    missed = []
    for name in arguments.scenes:
        scene = SCENES[name]
        identity = {"scene": digest(scene.file), "engine": digest(engine)}
        runs = [run for run in scene.runs() if arguments.full or not run.full]
        if arguments.methods:
            runs = [run for run in runs if run.labels.get("method", "") in arguments.methods + [""]]
        cases = {run: Case(os.path.join(arguments.output, name, run.name.replace(" ", "_")),
                           [word for option in [*run.options, "output.checkpoint_steps=0"] for word in ("--set", option)],
                           identity) for run in runs}
        if not arguments.tables_only:
            run_cases(list(cases.values()), arguments.program, engine, scene.file, arguments.jobs)
        rows = [Row(scene, run, case) for run, case in cases.items() if case.outcome()]
        parts = {"": [row for row in rows if not row.run.full], "-full": [row for row in rows if row.run.full]}
        for suffix, part in parts.items():
            if not part:
                continue
            checks = [] if suffix else [*scene.checks(part), momentum_kept(part)]
            missed += [f"{name}: {check.text}" for check in checks if check.gate and not check.state()]
            text = table_text(scene, part, checks)
            if suffix:
                text = f"{last_run(row.directory for row in part)}\n\n{text}"
            print(f"\n{name}{suffix}\n\n{text}")
            if not trial:
                write_csv(os.path.join(TOP, "docs", "data", "contact", f"{name}{suffix}.csv"), scene, part)
                replace_block(os.path.join(TOP, "docs", "validation.md"), f"{name.replace('_', '-')}{suffix}", text)
        if parts[""] and not trial:
            write_plot(os.path.join(TOP, "docs", "images", f"{name}.png"), scene, parts[""])
    if arguments.check and missed:
        raise Refused("not met: " + "; ".join(missed))


if __name__ == "__main__":
    run_main(main)
