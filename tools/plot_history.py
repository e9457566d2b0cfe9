#!/usr/bin/python3
"""Draws the speed of a body and the energies of a run against time, as PNG.

  plot_history.py RUN [RUN ...] [-o history.png] [--body rod] [--reference experiment=455]

RUN is a run's directory or its history.csv. Of several runs the speeds are drawn together, and the energies of the
first.
"""

import argparse
import csv
import os

import numpy as np

from plot_common import Refused, Units, label, plt, run_main, summary_of

# Columns of the ledger that make up the total, in the order of the legend; those that stay zero are left out.
ENERGIES = [("total", "total", "black"), ("kinetic", "kinetic", "#1f77b4"), ("internal", "internal", "#d62728"),
            ("failure_loss", "removed at failure", "#9467bd"), ("left_domain_energy", "left the domain", "#8c564b"),
            ("dropped_energy", "dropped as debris", "#17becf"),
            ("friction_dissipation", "friction", "#ff7f0e"), ("external_work", "external work", "#2ca02c"),
            ("residual", "residual", "#7f7f7f")]


class History:
    """The columns of a history.csv by their names."""

    def __init__(self, name):
        self.directory = name if os.path.isdir(name) else os.path.dirname(name) or "."
        self.file = os.path.join(name, "history.csv") if os.path.isdir(name) else name
        with open(self.file, newline="", encoding="utf-8") as file:
            rows = [row for row in csv.reader(file) if row]
        if len(rows) < 2 or "time" not in rows[0]:
            raise Refused(f"{self.file}: expected a heading with a column 'time' and at least one row")
        try:
            values = np.array(rows[1:], dtype=float)
        except ValueError as problem:
            raise Refused(f"{self.file}: {problem}") from None
        self.columns = {name.strip(): values[:, i] for i, name in enumerate(rows[0])}

    def __getitem__(self, name):
        if name not in self.columns:
            raise Refused(f"{self.file}: has no column '{name}'")
        return self.columns[name]

    def bodies(self):
        return [name[:-len(".speed")] for name in self.columns if name.endswith(".speed")]

    def fastest_body(self):
        if not self.bodies():
            raise Refused(f"{self.file}: has no column '<body>.speed'")
        return max(self.bodies(), key=lambda body: self[body + ".speed"][0])


def vectors(history, name):
    """The three columns of a vector, side by side."""
    return np.stack([history[f"{name}_{axis}"] for axis in "xyz"], axis=1)


def momentum_error(history):
    """What neither faces, gravity nor guides gave, of the bodies' largest momentum or the largest impulse of a run."""
    given = vectors(history, "boundary_impulse") + vectors(history, "external_impulse")
    # Histories of older versions have no debris.
    parts = [name for name in ("momentum", "left_domain_momentum", "dropped_momentum") if name + "_x" in history.columns]
    momentum = sum(vectors(history, name) for name in parts)
    largest = sum(np.linalg.norm(vectors(history, f"{body}.momentum"), axis=1) for body in history.bodies()).max()
    return np.abs(momentum - momentum[0] - given).max() / max(largest, np.abs(given).max())


def run_label(history):
    return os.path.basename(os.path.abspath(history.directory))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="RUN", help="run directory or history.csv")
    parser.add_argument("-o", "--output", default="history.png", help="picture to write (default history.png)")
    parser.add_argument("--body", help="body whose speed is drawn (default: the one that is fastest at the start)")
    parser.add_argument("--reference", action="append", default=[], metavar="LABEL=SPEED",
                        help="a speed to compare with, drawn as a dashed line; may be given again")
    parser.add_argument("--no-energy", action="store_true", help="the speed alone")
    parser.add_argument("--title", help="default: the scene's")
    parser.add_argument("--dpi", type=int, default=150)
    arguments = parser.parse_args()

    histories = [History(name) for name in arguments.runs]
    first = histories[0]
    units = Units(first.directory)
    body = arguments.body or first.fastest_body()
    time_unit, factor = units.time_scale(max(history["time"].max() for history in histories))

    count = 1 if arguments.no_energy else 2
    figure, panels = plt.subplots(1, count, squeeze=False, layout="constrained", figsize=(5.2 * count, 3.6))
    speed_panel = panels[0, 0]
    for history in histories:
        speed = history[body + ".speed"]
        name = f"{run_label(history)}: " if len(histories) > 1 else ""
        speed_panel.plot(factor * history["time"], speed, linewidth=1.6,
                         label=f"{name}{body}, {speed[-1]:.1f} {units.speed} at the end")
    for number, reference in enumerate(arguments.reference):
        text, _, value = reference.partition("=")
        try:
            value = float(value)
        except ValueError:
            raise Refused(f"--reference {reference}: expected LABEL=SPEED") from None
        speed_panel.axhline(value, color="black", linewidth=0.9, linestyle=["--", ":", "-."][number % 3],
                            label=f"{text}, {value:g} {units.speed}")
    speed_panel.set(xlabel=label("time", time_unit), ylabel=label(f"speed of the {body}", units.speed), ylim=(0, None))
    speed_panel.grid(alpha=0.25)
    speed_panel.legend()

    if count == 2:
        panel = panels[0, 1]
        energy_unit, energy_factor = units.energy
        largest = np.abs(first["total"]).max()
        for column, text, colour in ENERGIES:
            values = first.columns.get(column)
            if values is None or (column != "total" and np.abs(values).max() <= 1e-6 * largest):
                continue
            panel.plot(factor * first["time"], values / energy_factor, color=colour, label=text,
                       linewidth=1.8 if column == "total" else 1.3, linestyle="--" if column == "residual" else "-")
        panel.set(xlabel=label("time", time_unit), ylabel=label("energy", energy_unit))
        panel.grid(alpha=0.25)
        panel.legend()

    title = arguments.title or summary_of(first.directory).get("title", "")
    if title:
        figure.suptitle(title)
    figure.savefig(arguments.output, dpi=arguments.dpi)
    print(arguments.output)


if __name__ == "__main__":
    run_main(main)
