#!/usr/bin/env python3
"""Random small scenes within the documented ranges: each runs to its end with mass and momentum accounted for, or stops with a
clear error.

  bench/soak.py PROGRAM [--count 10000] [--seed S] [--first N] [--jobs J] [--work DIR] [--keep]

Scene number N of seed S is always the same: `--first N --count 1 --keep` makes it again and leaves it in DIR. The classes:

  closed      ended; the energy ledger is closed to 2 % of what there was at first and came in
  stopped     ended, but more energy is unaccounted for, and a warning said so (contact that is few cells wide; settings that are not
              stable, such as large time-step factors, trilinear functions with FLIP, USL): run again with energy_limit and
              energy_loss_limit of 2 % it stopped (exit code 3) and said when, how much and why
  broken      broke down (exit code 3) with particle, place, time and cause
  refused     the scene was refused (exit code 2) with one line that names key, value and expectation
  FAILED      anything else: another exit code, a signal, no end within a minute, a number that is not finite, mass or momentum
              not accounted for to 1e-8, a message of none or several lines, a ledger that is open without a warning or with
              limits that should have stopped it

Prints the counts; the exit code is 1 where something FAILED."""

import argparse
import collections
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

CUBE = pathlib.Path(__file__).resolve().parents[1] / "tests/data/cli/cube.stl"
CLOSED = 0.02
EXACT = 1e-8


class Scene:
    """TOML of one random scene. Lengths are in cells; all values are scaled to units of its own at the end."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.added = random.Random(f"{seed} added")  # what came later: the scenes of a seed stay otherwise as they were
        r = self.random
        # One unit of length, time and mass of the numbers below, in the scene's units.
        self.L, self.T, self.M = (10 ** r.uniform(-4, 4) if r.random() < 0.5 else 1.0 for _ in range(3))
        self.symmetric = [r.random() < 0.15 for _ in range(3)]
        self.lines = []
        self.names, self.rigid = [], []
        self.write()

    def chance(self, p):
        return self.random.random() < p

    def log(self, low, high):
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def length(self, x):
        return x * self.L

    def lengths(self, v):
        return [x * self.L for x in v]

    def speed(self, x):
        return x * self.L / self.T

    def stress(self, x):
        return x * self.M / (self.L * self.T ** 2)

    def say(self, line=""):
        self.lines.append(line)

    def value(self, key, x):
        self.say(f"{key} = {json.dumps(x)}")

    def material(self, name):
        r = self.random
        density = self.log(1e-3, 2e-2)
        young = self.log(1e2, 3e5)
        nu = r.uniform(-0.2, 0.49)
        bulk = young / (3 * (1 - 2 * nu))
        kind = r.choice(["elastic", "neo_hookean", "j2_power", "johnson_cook", "j2_mixed", "j2_multiplicative"])
        self.waves.append(math.sqrt((bulk + 2 * young / (3 * (1 + nu))) / density))
        self.say(f"[materials.{name}]")
        self.value("density", density * self.M / self.L ** 3)
        if self.chance(0.5):
            constants = {"youngs_modulus": self.stress(young), "poisson_ratio": nu}
        else:
            constants = {"bulk_modulus": self.stress(bulk), "shear_modulus": self.stress(young / (2 * (1 + nu)))}
        if kind in ("j2_power", "johnson_cook"):
            strength = young * self.log(1e-4, 1e-1)
            constants |= {"A": self.stress(strength), "B": self.stress(strength * r.uniform(0, 5)), "n": r.uniform(0.05, 1)}
        if kind in ("j2_mixed", "j2_multiplicative"):
            strength = young * self.log(1e-4, 1e-1)
            constants |= {"yield_stress": self.stress(strength), "H": self.stress(strength * r.uniform(0, 5)), "c": r.uniform(0, 1)}
        if kind == "johnson_cook":
            if self.chance(0.6):
                constants |= {"C": r.uniform(0, 0.1), "reference_strain_rate": self.log(1e-3, 1) / self.T}
            if self.chance(0.6):
                constants |= {"m": r.uniform(0.3, 2), "melt_temperature": r.uniform(400, 2000),
                              "specific_heat": self.log(100, 2000) * (self.L / self.T) ** 2}
        self.say(f"[materials.{name}.{kind}]")
        for key, x in constants.items():
            self.value(key, x)
        if kind not in ("neo_hookean", "j2_mixed", "j2_multiplicative") and self.chance(0.3):
            self.say(f"[materials.{name}.mie_gruneisen]")
            self.value("c0", self.speed(math.sqrt(bulk / density) * r.uniform(0.8, 1.2)))
            self.value("s", r.uniform(0, 2))
            self.value("gamma0", r.uniform(0, 3))
        if kind in ("j2_power", "johnson_cook") and self.chance(0.4):
            self.say(f"[materials.{name}.failure]")
            self.value("plastic_strain", self.log(0.02, 3))
        if self.chance(0.3):
            self.say(f"[materials.{name}.viscosity]")
            self.value("linear", r.uniform(0, 0.3))
            self.value("quadratic", r.uniform(0, 2))

    def direction(self):
        return [self.random.gauss(0, 1) for _ in range(3)]

    def body(self, name, centre, materials):
        r = self.random
        formulation = r.choices(["deformable", "total_lagrangian", "rigid", "rigid_prescribed"], [0.57, 0.18, 0.13, 0.12])[0]
        shape = r.choice(["box", "cylinder", "sphere", "ogive_rod", "mesh", "particles"])
        size, spacing = r.uniform(0.7, 1.3), r.uniform(0.35, 0.6)
        speed = max(self.waves) * self.log(1e-4, 0.3)
        towards = [-c + r.uniform(-1, 1) for c in centre]
        norm = math.sqrt(sum(c * c for c in towards)) or 1
        self.say(f"[bodies.{name}]")
        self.value("material", r.choice(materials))
        self.value("formulation", formulation)
        if formulation == "total_lagrangian":
            self.lagrangian = True
            if self.chance(0.5):
                self.value("distortion_limit", self.log(1.1, 30))
                self.value("when_distorted", r.choice(["update", "stop"]))
        if formulation == "rigid_prescribed" and self.chance(0.5):
            motion = True
        else:
            motion = False
            if self.chance(0.9):
                self.value("velocity", [self.speed(speed * c / norm) for c in towards])
            if self.chance(0.2):
                self.value("angular_velocity", [x * speed / 3 / self.T for x in self.direction()])
                self.value("angular_centre", self.lengths(centre))
        if shape == "mesh":
            self.value("mesh", "cube.stl")
            self.value("scale", self.length(0.5 * size))
            self.value("spacing", self.length(spacing))
            self.value("position", self.lengths(centre))
            if self.chance(0.3):
                self.value("axis", self.direction())
        elif shape == "particles":
            n = r.randint(1, 4)
            self.particles[name] = [([self.length(c + (i - 1.5) * spacing) for c, i in zip(centre, (x, y, z))],
                                     self.length(spacing) ** 3) for x in range(n) for y in range(n) for z in range(n)]
            self.value("particles", f"{name}.csv")
        else:
            self.value("spacing", self.lengths([spacing] * 3) if self.chance(0.3) else self.length(spacing))
            placement = f"centre = {self.lengths(centre)}"
            if self.chance(0.5):
                placement += f", axis = {self.direction()}"
            s = self.length(size)
            table = {"box": f"size = [{s}, {s}, {0.8 * s}]",
                     "sphere": f"radius = {0.8 * s}",
                     "cylinder": f"radius = {0.7 * s}, length = {s}" +
                                 (f", inner_radius = {0.3 * s}" if self.chance(0.3) else ""),
                     "ogive_rod": f"radius = {0.4 * s}, length = {1.5 * s}, caliber_radius_head = {r.uniform(0.5, 2)}"}[shape]
            self.say(f"{shape} = {{ {table}, {placement} }}")
            if shape == "cylinder" and self.chance(0.3):
                self.value("lattice", "polar")
        if formulation == "deformable" and self.added.random() < 0.2:
            self.say(f"coarse = {{ beyond = {self.length(self.added.uniform(0.2, 3))}, from = {self.lengths(centre)}, "
                     f"to = {self.lengths([0, 0, 0])} }}")
        if motion:
            for k in range(r.randint(1, 3)):
                self.say(f"[[bodies.{name}.motion]]")
                self.value("time", k * 0.3 * self.end)
                self.value("velocity", [self.speed(speed * x) for x in self.direction()])
                self.value("angular_velocity", [x * 0.1 * speed / self.T for x in self.direction()])
        self.rigid.append(formulation.startswith("rigid"))

    def rule(self, wall=False):
        r = self.random
        self.value("method", r.choice(["huang_first", "huang_second", "york", "hu_chen", "bardenhagen_2000",
                                       "bardenhagen_2001", "pan_2008", "persistent"] + ([] if wall else ["single_field"])))
        if not wall and self.chance(0.6):
            self.value("normal", r.choice(["average", "master", "volume_gradient", "occupied_cell", "logistic_regression"]))
        if self.chance(0.5):
            self.value("friction", r.uniform(0, 1))
        if self.chance(0.5):
            detection = r.choice(["gap", "shared_node"])
            self.value("detection", "surface" if self.added.random() < 0.25 else detection)
        if self.chance(0.3):
            self.value("gap_offset", r.uniform(-0.5, 1))

    def write(self):
        r = self.random
        self.particles = {}
        self.waves = []
        self.lagrangian = False
        materials = [f"m{i}" for i in range(r.randint(1, 3))]
        head, self.lines = self.lines, []
        for name in materials:
            self.material(name)
        material_lines, self.lines = self.lines, []

        # Long enough for the slowest bodies to meet; max_steps bounds the work.
        self.end = r.uniform(3, 30) / max(self.waves)
        corners = [[x, y, z] for x in (-2.2, 2.2) for y in (-2.2, 2.2) for z in (-2.2, 2.2)]
        # Bodies beyond a symmetry face are cut away: only corners inside.
        corners = [[abs(c) if s else c for c, s in zip(corner, self.symmetric)] for corner in corners]
        corners = [list(c) for c in sorted({tuple(c) for c in corners})]
        r.shuffle(corners)
        for i, corner in enumerate(corners[:r.randint(1, 4)]):
            name = f"body{i}"
            self.names.append(name)
            # Some sit on the mirror.
            centre = [0.0 if s and self.chance(0.3) and i == 0 else c for c, s in zip(corner, self.symmetric)]
            self.body(name, centre, materials)
        body_lines, self.lines = self.lines, []

        self.say('units = { length = "%s", time = "%s", mass = "%s" }' % (
            r.choice(["m", "cm", "mm", "um", "in", "ft"]), r.choice(["s", "ms", "us"]), r.choice(["kg", "g", "mg", "t", "lb"])))
        self.say("[grid]")
        self.value("cell_size", self.length(1))
        self.value("lower", self.lengths([0 if s else -5 for s in self.symmetric]))
        self.value("upper", self.lengths([5] * 3))
        self.say("[grid.faces]")
        for axis, symmetric in zip("xyz", self.symmetric):
            self.value(f"{axis}_min", "symmetry" if symmetric else r.choice(["free", "free", "fixed"]))
            self.value(f"{axis}_max", r.choice(["free", "free", "fixed", "symmetry"]))
        self.say("[numerics]")
        self.value("shape_function", r.choice(["linear", "quadratic_bspline"] + ([] if self.lagrangian else ["gimp"])))
        self.value("time_step_factor", r.uniform(0.05, 0.55) if self.chance(0.85) else r.uniform(0.5, 1.5))
        transfer = r.choice(["affine_flip", "flip", "apic", "xpic"])
        self.value("transfer", transfer)
        if transfer == "xpic":
            self.value("xpic_order", r.randint(1, 6))
        if self.chance(0.3):
            self.value("pic_fraction", r.uniform(0, 1))
        self.value("update_order", r.choice(["stress_first", "stress_last", "stress_last_as_is"]))
        if self.chance(0.3):
            self.value("skip_resting", False)
        if self.chance(0.3) or all(self.rigid):
            self.value("maximum_time_step", 0.1 * self.end * self.T)
        if self.chance(0.3):
            self.value("gravity", [x * 0.01 * max(self.waves) / self.end * self.L / self.T ** 2 for x in self.direction()])
        if self.added.random() < 0.3:
            self.say("drop_debris = true")
        self.say("[contact]")
        self.rule()
        if len(self.names) > 1 and self.chance(0.4):
            self.say("[[contact.pairs]]")
            self.value("bodies", r.sample(self.names, 2))
            self.rule()
        if self.chance(0.3):
            self.say("[[walls]]")
            self.value("point", self.lengths([0, 0, -4]))
            self.value("normal", [r.uniform(-0.1, 0.1), r.uniform(-0.1, 0.1), 1])
            self.rule(wall=True)
        if self.chance(0.3):
            self.say("[[clamps]]")
            if self.chance(0.5):
                self.value("region", "box")
                self.value("lower", self.lengths([-5, -5, -5]))
                self.value("upper", self.lengths([5, 5, -2.5]))
            else:
                self.value("region", "outside_cylinder")
                self.value("centre", [0, 0, 0])
                self.value("axis", self.direction())
                self.value("radius", self.length(3))
            deformable = [n for n, rigid in zip(self.names, self.rigid) if not rigid]
            if deformable and self.chance(0.4):
                self.value("body", r.choice(deformable))
            self.value("axes", r.choice(["xyz", "x", "yz"]))
        self.say("[stop]")
        self.value("time", self.end * self.T)
        self.value("max_steps", r.randint(50, 300))
        if self.chance(0.3):
            self.value("body", r.choice(self.names))
            if self.chance(0.5):
                self.value("settle_window", 0.2 * self.end * self.T)
                self.value("settle_tolerance", self.speed(1e-3 * max(self.waves)))
        if self.added.random() < 0.2:
            self.value("exchange_window", 0.1 * self.end * self.T)
        self.say("[output]")
        self.value("checkpoint_steps", 0)
        self.value("history_interval", 0.5 * self.end * self.T)
        self.lines = head + self.lines + material_lines + body_lines

    def save(self, directory):
        (directory / "scene.toml").write_text("\n".join(self.lines) + "\n")
        shutil.copy(CUBE, directory / "cube.stl")
        for name, particles in self.particles.items():
            with open(directory / f"{name}.csv", "w") as file:
                for place, volume in particles:
                    file.write(",".join(repr(x) for x in place + [volume]) + "\n")


def numbers(value, path=""):
    if isinstance(value, dict):
        for key, part in value.items():
            yield from numbers(part, f"{path}.{key}")
    elif isinstance(value, list):
        for part in value:
            yield from numbers(part, path)
    elif value is None or isinstance(value, float):
        yield path, value


def judge(directory, code, errors):
    """The class of a run, and what there is to say."""
    # Growing energy is told as soon as it is seen, before what ends the run.
    errors = "".join(line for line in errors.splitlines(True) if not line.startswith("warning: the energy has grown by "))
    one_line = errors.count("\n") == 1
    if code == 2:
        return ("refused", errors.strip()) if one_line and "scene.toml" in errors else ("FAILED", errors)
    if code == 3:
        told = all(part in errors for part in ("the computation broke down: ", "probable cause: "))
        return ("broken", errors.strip()) if one_line and told else ("FAILED", errors)
    if code != 0:
        return "FAILED", f"exit code {code}: {errors[-500:]}"
    summary = json.loads((directory / "out/summary.json").read_text())
    for path, value in numbers(summary):
        if path.endswith((".first_failure_time", ".warning_time")):  # null: never
            continue
        if value is None or not math.isfinite(value):
            return "FAILED", f"{path} is not finite"
    with open(directory / "out/history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    first, last = rows[0], rows[-1]
    number = lambda row, key: float(row[key])
    mass = number(first, "mass")
    if abs(number(last, "mass") + number(last, "left_domain_mass") + number(last, "dropped_mass") - mass) > EXACT * mass:
        return "FAILED", "mass is not accounted for"
    scale = mass * number(last, "maximum_speed_ever")
    for axis in "xyz":
        now = sum(number(last, f"{which}momentum_{axis}") for which in ("", "left_domain_", "dropped_"))
        boundary, external = number(last, f"boundary_impulse_{axis}"), number(last, f"external_impulse_{axis}")
        given = boundary + external
        # What is held under gravity has no momentum, but two impulses that cancel, each with its round-off.
        if abs(now - given - number(first, f"momentum_{axis}")) > EXACT * (scale + abs(boundary) + abs(external)):
            return "FAILED", f"momentum {axis}: {now - given - number(first, f'momentum_{axis}'):g} of {scale:g} unaccounted for"
    energy = summary["energy"]
    residual = energy["unaccounted"]
    if abs(residual) <= CLOSED:
        return "closed", f"{residual:+.3g}"
    told = any(line.startswith(("WARNING: the energy grew by ", "WARNING: the energy ledger does not close: "))
               for line in errors.splitlines())
    return ("open" if told else "FAILED"), f"{residual:+.3g}" + ("" if told else " of the energy is unaccounted for, and no word of it")


def run(arguments, directory, *settings):
    result = subprocess.run([arguments.program, "run", "scene.toml", "--output", "out", *settings], cwd=directory,
                            capture_output=True, text=True, timeout=60 * arguments.patience, env=dict(os.environ, OMP_NUM_THREADS="1"))
    return judge(directory, result.returncode, result.stderr)


def try_scene(arguments, number):
    directory = arguments.work / f"scene-{number}"
    shutil.rmtree(directory, ignore_errors=True)
    directory.mkdir(parents=True)
    Scene(f"{arguments.seed} {number}").save(directory)
    try:
        outcome = run(arguments, directory)
        if outcome[0] == "open":
            limits = [word for key in ("energy_limit", "energy_loss_limit") for word in ("--set", f"numerics.{key}={CLOSED}")]
            strict, text = run(arguments, directory, "--overwrite", *limits)
            stopped = strict == "broken" and ("energy_limit: " in text or "energy_loss_limit: " in text)
            outcome = ("stopped" if stopped else "FAILED"), f"{outcome[1]}; with limits {strict}: {text}"
    except subprocess.TimeoutExpired:
        outcome = "FAILED", "no end within a minute"
    if not arguments.keep and outcome[0] != "FAILED":
        shutil.rmtree(directory, ignore_errors=True)
    return number, *outcome


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--patience", type=int, default=1, help="minutes for each scene, more where the machine is busy")
    parser.add_argument("--work", type=pathlib.Path, default=None, help="default: a temporary directory")
    parser.add_argument("--keep", action="store_true", help="keep every scene with its results, not only those that FAILED")
    parser.add_argument("--verbose", action="store_true")
    arguments = parser.parse_args()
    arguments.program = arguments.program.resolve()
    temporary = arguments.work is None
    arguments.work = arguments.work or pathlib.Path(tempfile.mkdtemp(prefix="ogive-soak-"))
    arguments.work = arguments.work.resolve()
    counts = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for number, kind, text in pool.map(lambda n: try_scene(arguments, n),
                                           range(arguments.first, arguments.first + arguments.count)):
            counts[kind] += 1
            if kind == "FAILED" or arguments.verbose:
                print(f"scene {number}: {kind}: {text}", flush=True)
    total = sum(counts.values())
    print(f"seed {arguments.seed}, scenes {arguments.first}..{arguments.first + total - 1}: " +
          ", ".join(f"{kind} {counts[kind]}" for kind in ("closed", "stopped", "broken", "refused", "FAILED")))
    if temporary and counts["FAILED"] == 0:
        shutil.rmtree(arguments.work, ignore_errors=True)
    return 1 if counts["FAILED"] else 0


if __name__ == "__main__":
    sys.exit(main())
