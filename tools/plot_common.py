"""What the plotting tools share: units and title of a run, times with a handy unit, readable errors."""

import json
import os
import sys

import matplotlib

matplotlib.use("Agg")  # pictures go to files: no display is needed
import matplotlib.pyplot as plt  # noqa: E402

plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 9, "figure.titlesize": 11, "axes.spines.top": False, "axes.spines.right": False,
    "legend.frameon": False, "savefig.bbox": "tight", "figure.dpi": 100,
})


class Refused(Exception):
    """Bad input; the message goes to the user as it is."""


def run_main(main):
    """Runs a tool: an expected failure is one line on stderr and exit code 1."""
    try:
        main()
    except (Refused, OSError) as problem:
        sys.exit(f"{os.path.basename(sys.argv[0])}: {problem}")


def summary_of(directory):
    """summary.json of a run as a dictionary, empty if there is none (a run that has not ended)."""
    try:
        with open(os.path.join(directory, "summary.json"), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}


def scene_of(directory):
    """The scene that a run came from, parsed, empty if it is not to be found."""
    import tomllib
    name = summary_of(directory).get("scene", "")
    for candidate in (name, os.path.join(directory, name), os.path.join(directory, "scene.toml")):
        try:
            with open(candidate, "rb") as file:
                return tomllib.load(file)
        except (OSError, ValueError):
            continue
    return {}


class Units:
    """Labels of a run's units; empty where they are not known."""

    def __init__(self, directory):
        units = summary_of(directory).get("units") or scene_of(directory).get("units") or {}
        self.length = units.get("length", "")
        self.time = units.get("time", "")
        self.mass = units.get("mass", "")

    @property
    def speed(self):
        if (self.length, self.time) in (("mm", "ms"), ("m", "s")):
            return "m/s"
        return f"{self.length}/{self.time}" if self.length and self.time else ""

    @property
    def stress(self):
        usual = {("mm", "ms", "g"): "MPa", ("m", "s", "kg"): "Pa"}
        return usual.get((self.length, self.time, self.mass), "")

    @property
    def energy(self):
        """Name of the unit, and how many of the run's own make one: joules are easier to read than millijoules."""
        usual = {("mm", "ms", "g"): ("J", 1000.0), ("m", "s", "kg"): ("kJ", 1000.0)}
        return usual.get((self.length, self.time, self.mass), ("", 1.0))

    def time_scale(self, longest):
        """Name and factor for times up to `longest`: 0.12 ms reads better as 120 us."""
        if self.time == "ms" and longest < 1:
            return "µs", 1e3
        if self.time == "s" and longest < 1e-3:
            return "µs", 1e6
        if self.time == "s" and longest < 1:
            return "ms", 1e3
        return self.time, 1.0


def label(name, unit):
    """'x [mm]', or 'x' where the unit is not known."""
    return f"{name} [{unit}]" if unit else name
