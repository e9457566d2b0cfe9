"""What the validation tools share: reference tables, many runs side by side, blocks in documents."""

import argparse
import csv
import datetime
import hashlib
import json
import os
import signal
import subprocess
import time
import tomllib

from plot_common import Refused, summary_of

SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "examples", "scenes")
NO_FILES = ["output.particle_interval=0", "output.checkpoint_steps=0"]  # settings of runs that are to be timed

# Methods that are run with FLIP: with affine velocities their first phase, which the particles do not feel, makes energy
# (docs/decisions.md).
FLIP_ALONE = {method: ["numerics.transfer=flip"] for method in ("york", "hu_chen", "pan_2008")}


def read_rows(path):
    """A CSV with '#' lines of sources: its rows, each {column: text}."""
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def read_references(path):
    """A CSV with '#' lines of sources: {first column: {column: number}}."""
    rows = read_rows(path)
    key = next(iter(rows[0]))
    return {float(row[key]): {name: float(value) for name, value in row.items()} for row in rows}


def numerics_text(scene_file, settings):
    """The numerics of a scene with what --set gives it, in words."""
    with open(scene_file, "rb") as file:
        scene = tomllib.load(file)

    def merge(into, table):
        for key, value in table.items():
            if isinstance(value, dict) and isinstance(into.get(key), dict):
                merge(into[key], value)
            else:
                into[key] = value

    for setting in settings:
        if setting.startswith("@"):
            with open(setting[1:], "rb") as file:
                merge(scene, tomllib.load(file))
        else:
            path, value = setting.split("=", 1)
            *tables, key = path.split(".")
            try:
                value = tomllib.loads(f"value = {value}")["value"]
            except tomllib.TOMLDecodeError:
                pass  # a bare word
            for table in reversed(tables):
                key, value = table, {key: value}
            merge(scene, {key: value})
    numerics, contact = scene["numerics"], scene["contact"]
    words = [f"`{numerics['shape_function']}`", f"`{numerics['transfer']}`"]
    if numerics.get("pic_fraction"):
        words.append(f"{100 * numerics['pic_fraction']:g} % of the grid's velocity a step")
    words += [f"`{numerics['update_order']}`", f"time-step factor {numerics['time_step_factor']:g}"]
    if contact["method"] != "single_field":
        offset = f" (offset {contact['gap_offset']:g} cells)" if contact["detection"] == "gap" else ""
        words.append(f"contact detection `{contact['detection']}`{offset}")
        words.append(f"the {contact['master']}'s normals" if contact["normal"] == "master" else f"{contact['normal']} normals")
    return ", ".join(words)


def digest(*paths):
    """A short checksum of files."""
    total = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            total.update(file.read())
    return total.hexdigest()[:16]


def machine():
    """The processor's name and how many there are."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        models = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return f"{models[0] if models else 'unknown processor'}, {os.cpu_count()} processors"


def last_run(directories):
    """When the newest of these runs ended, and the machine that this is."""
    ended = max(os.path.getmtime(os.path.join(directory, "case.json")) for directory in directories)
    return f"Last run on {datetime.date.fromtimestamp(ended)}, {machine()}."


def engine_of(program):
    """The library that a built program runs with; both must be there."""
    engine = os.path.realpath(os.path.join(os.path.dirname(program), "..", "lib", "libogive.so"))
    for path in (program, engine):
        if not os.path.exists(path):
            raise Refused(f"{path}: not there; build with: cmake --preset release && cmake --build --preset release")
    return engine


class Case:
    """One run of the program: where it is, how it is called, and what came of it."""

    def __init__(self, directory, options, identity):
        self.directory = directory
        self.options = options  # of `ogive run`, without scene and output
        self.identity = identity  # of program and scene
        self.process = None
        self.started = 0.0

    def _record(self):
        return {"options": self.options, **self.identity}

    @property
    def _record_file(self):
        return os.path.join(self.directory, "case.json")

    def outcome(self):
        """{"summary": ...} or {"failure": text} of a run that has ended with these options and this program; else None."""
        try:
            with open(self._record_file, encoding="utf-8") as file:
                record = json.load(file)
            outcome = record.pop("outcome")
            if record != self._record():
                return None
            if "failure" in outcome:
                return outcome
            with open(os.path.join(self.directory, "summary.json"), encoding="utf-8") as file:
                return {"summary": json.load(file)}
        except (OSError, ValueError, KeyError):
            return None

    def start(self, program, scene):
        os.makedirs(os.path.dirname(self.directory), exist_ok=True)
        self.log = open(self.directory + ".log", "w", encoding="utf-8")
        self.started = time.monotonic()
        self.process = subprocess.Popen(
            [program, "run", scene, "--output", self.directory, "--overwrite", "--threads", "1", *self.options],
            stdout=self.log, stderr=subprocess.STDOUT)

    def finish(self, engine):
        """After the process has ended: keeps the outcome where it is one. Returns it in words."""
        code = self.process.returncode
        self.log.close()
        with open(self.log.name, encoding="utf-8") as file:
            lines = file.read().split("\n")
        last = next((line for line in reversed(lines) if line.strip()), "")
        if code not in (0, 3):  # 3: the computation broke down, which is a result too
            raise Refused(f"{self.directory}: exit code {code}: {last}")
        if digest(engine) != self.identity["engine"]:
            raise Refused(f"{self.directory}: {engine} was built anew in the meantime")
        outcome = {} if code == 0 else {"failure": last}
        with open(self._record_file, "w", encoding="utf-8") as file:
            json.dump({**self._record(), "outcome": outcome}, file, indent=2)
        return last if code else "done"


def run_cases(cases, program, engine, scene, jobs):
    """Runs those that have no outcome yet, `jobs` at a time. An interruption ends the running ones; the rest is kept."""
    waiting = [case for case in cases if case.outcome() is None]
    if len(waiting) < len(cases):
        print(f"{len(cases) - len(waiting)} of {len(cases)} runs are there already", flush=True)
    running, problems = [], []
    try:
        while waiting or running:
            while waiting and len(running) < jobs:
                case = waiting.pop(0)
                case.start(program, scene)
                running.append(case)
            time.sleep(0.2)
            for case in [case for case in running if case.process.poll() is not None]:
                running.remove(case)
                try:
                    words = case.finish(engine)
                except Refused as problem:
                    problems.append(str(problem))
                    words = str(problem)
                print(f"{case.directory}: {words} ({time.monotonic() - case.started:.0f} s), "
                      f"{len(waiting) + len(running)} to go", flush=True)
    finally:
        for case in running:
            case.process.send_signal(signal.SIGTERM)
        for case in running:
            case.process.wait()
    if problems:
        raise Refused(f"{len(problems)} runs could not be made; the first: {problems[0]}")


def replace_block(path, name, text):
    """Puts text between <!-- name:begin --> and <!-- name:end --> of a document, which must have each of them once, in this
    order. (Where a document has none yet, nobody but its author knows where the text belongs.)"""
    begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
    with open(path, encoding="utf-8") as file:
        document = file.read()
    for mark in (begin, end):
        if document.count(mark) != 1:
            raise Refused(f"{path}: {mark} must be there once, got {document.count(mark)}")
    before, rest = document.split(begin)
    if end not in rest:
        raise Refused(f"{path}: {end} must come after {begin}")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"{before}{begin}\n{text.strip()}\n{end}{rest.split(end)[1]}")


def markdown_table(heading, rows):
    lines = ["| " + " | ".join(heading) + " |", "|" + "---|" * len(heading)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def read_table(path):
    """As read_rows; none where there is no file."""
    return read_rows(path) if os.path.exists(path) else []


def write_table(path, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def table_arguments(purpose, program):
    """The parser of a tool that runs scenes with a built program and writes a table: --program, --work, --table-only."""
    parser = argparse.ArgumentParser(description=purpose, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=program, help="the program ogive")
    parser.add_argument("--work", help="where the runs go (default: a temporary directory)")
    parser.add_argument("--table-only", action="store_true", help="no runs: the table from the data")
    return parser


def run_scene(program, scene, directory, settings):
    """The summary of an example scene, run on one thread into the directory unless that holds one already."""
    if not os.path.exists(os.path.join(directory, "summary.json")):
        command = [program, "run", os.path.join(SCENES, scene), "-o", directory, "--overwrite"]
        command += [part for setting in ["numerics.threads=1", *settings] for part in ("--set", setting)]
        # By a shell: this process's own memory would be in the peak of a child of its own.
        subprocess.run(["sh", "-c", '"$@"; exit $?', "sh", *command], check=True, stdout=subprocess.DEVNULL)
    return summary_of(directory)


def value_of(summary, path):
    """The number that stands in a summary under these keys."""
    for key in path:
        summary = summary[key]
    return float(summary)
