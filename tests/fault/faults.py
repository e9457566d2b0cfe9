#!/usr/bin/env python3
"""What is promised when the process, the disk or the input fails, tried at many random points.

  tests/fault/faults.py PROGRAM SHIM [--count N] [--seed S] [--only KIND,...] [--work DIR]

Each of the kinds below is tried N times on a run of a few hundred steps with history, particle files and checkpoints. After each
fault the run goes on by `ogive restart DIRECTORY` (or, where there was no checkpoint yet, starts again), and all files must be
those of an undisturbed run, byte for byte, but for wall time, speed and memory in summary.json. Prints a line for each kind: tried,
failed; the exit code is 1 where something failed."""

import argparse
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SCENE = pathlib.Path(__file__).resolve().parents[1] / "data/cli/two_boxes.toml"
SETTINGS = ["output.checkpoint_steps=25", "numerics.time_step_factor=0.3"]
MACHINE = ["wall_seconds", "particle_steps_per_second", "peak_memory_bytes", "cpu_seconds"]


class Failed(Exception):
    pass


def expect(holds, what):
    if not holds:
        raise Failed(what)


class Bench:
    def __init__(self, program, shim, work, seed):
        self.program, self.shim, self.work = program, shim, work
        self.random = random.Random(seed)
        self.reference = work / "reference"
        start = time.monotonic()
        self.run(self.command(self.reference), expected=[0])
        self.seconds = time.monotonic() - start
        self.run(self.command(self.work / "counted"), expected=[0],
                 OGIVE_FAULT_COUNT=str(work / "count"))
        self.calls = int((work / "count").read_text())
        self.same(self.work / "counted")

    def command(self, directory, *more):
        settings = [word for setting in SETTINGS for word in ("--set", setting)]
        return [self.program, "run", str(SCENE), "--output", str(directory), *settings, *more]

    def start(self, command, limit=None, **environment):
        def before():
            if limit:
                resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
        if environment:
            environment["LD_PRELOAD"] = str(self.shim)
        return subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                preexec_fn=before if limit else None, env=dict(os.environ, **environment), cwd=self.work)

    def finish(self, process, expected):
        output, errors = process.communicate(timeout=60)
        code = process.returncode
        expect(code in expected, f"exit code {code}, expected {expected}; it said: {errors.strip()[-300:]}")
        if code not in (0, 75, -signal.SIGKILL) and code > 0:
            expect(errors.strip() and errors.count("\n") == 1, f"not one line for the user: {errors!r}")
        return code, output, errors

    def run(self, command, expected, limit=None, **environment):
        return self.finish(self.start(command, limit, **environment), expected)

    def new(self):
        directory = self.work / "run"
        shutil.rmtree(directory, ignore_errors=True)
        return directory

    def same(self, directory):
        for path in sorted(self.reference.iterdir()):
            # Checkpoints hold the wall time, and one that a signal made stands among the last ones that are kept.
            if path.name == ".ogive-lock" or path.name.startswith("checkpoint-"):
                continue
            other = directory / path.name
            expect(other.exists(), f"{path.name} is missing")
            if path.name == "summary.json":
                a, b = (json.loads(p.read_text()) for p in (path, other))
                for key in MACHINE:
                    a.pop(key), b.pop(key)
                expect(a == b, "another summary.json")
            else:
                expect(path.read_bytes() == other.read_bytes(), f"another {path.name}")
        def names(of):
            everything = {p.name for p in of.iterdir()} - {".ogive-lock"}
            checkpoints = sorted(n for n in everything if n.startswith("checkpoint-") and n.endswith(".h5"))
            return everything - set(checkpoints) | set(checkpoints[-1:])
        expect(names(directory) == names(self.reference),
               f"other files: {names(directory) ^ names(self.reference)}")

    def go_on(self, directory, *more):
        """To the end, as a user would."""
        if (directory / "summary.json").exists():
            return
        code, _, errors = self.run([self.program, "restart", directory], expected=[0, 4])
        if code == 4:
            expect("holds no checkpoint" in errors or not directory.exists(), errors)
            self.run(self.command(directory, *more, "--overwrite"), expected=[0])

    def recover(self, directory):
        self.go_on(directory)
        self.same(directory)

    # ------------------------------------------------------------------------------------------------- kinds of fault

    def kill_stepping(self):
        directory = self.new()
        process = self.start(self.command(directory))
        time.sleep(self.random.uniform(0, self.seconds))
        process.kill()
        self.finish(process, [-signal.SIGKILL, 0])
        self.recover(directory)

    def at_call(self, actions, expected, say=None):
        directory = self.new()
        action, number = self.random.choice(actions), self.random.randint(1, self.calls)
        try:
            code, _, errors = self.run(self.command(directory), expected, OGIVE_FAULT=f"{action}:{number}")
            expect(not say or code == 0 or say(errors), f"does not say what happened: {errors}")
            self.recover(directory)
        except Failed as failed:
            raise Failed(f"{action}:{number}: {failed}")

    def kill_writing(self):
        self.at_call(["kill", "half", "after"], [-signal.SIGKILL, 0])

    def kill_twice(self):
        """And again while the restart writes."""
        directory = self.new()
        self.run(self.command(directory), [-signal.SIGKILL, 0], OGIVE_FAULT=f"kill:{self.random.randint(1, self.calls)}")
        self.run([self.program, "restart", directory], [-signal.SIGKILL, 0, 4],
                 OGIVE_FAULT=f"{self.random.choice(['kill', 'half', 'after'])}:{self.random.randint(1, self.calls // 2)}")
        self.recover(directory)

    def disk_full(self):
        self.at_call(["space", "quota"], [4, 0], lambda text: "No space left" in text or "quota exceeded" in text)

    def disk_error(self):
        self.at_call(["io", "once"], [4, 0], lambda text: "nput/output error" in text)

    def read_only(self):
        self.at_call(["readonly", "access"], [4, 0], lambda text: "Read-only" in text or "ermission denied" in text)

    def partial_writes(self):
        self.at_call(["short", "intr"], [0])

    def signals(self):
        directory = self.new()
        process = self.start(self.command(directory))
        while not (directory / "history.csv").exists() and process.poll() is None:
            time.sleep(0.001)
        time.sleep(self.random.uniform(0, self.seconds))
        process.send_signal(self.random.choice([signal.SIGTERM, signal.SIGINT, signal.SIGHUP]))
        code, output, _ = self.finish(process, [75, 0])
        expect(code == 0 or "to go on: ogive restart" in output, "does not say how to go on")
        self.recover(directory)

    def clock_jumps(self):
        directory = self.new()
        self.run(self.command(directory), [0], OGIVE_FAULT_CLOCK=str(self.random.randint(1, 10**9)))
        self.same(directory)

    def least_memory(self, command, expected):
        """The least address space, to 64 KiB, in which a command comes to its end."""
        low, high = 1 << 20, 1 << 32
        while high - low > 1 << 16:
            middle = (low + high) // 2
            process = self.start(command, middle)
            process.communicate(timeout=60)
            low, high = (low, middle) if process.returncode in expected else (middle, high)
        return high

    def memory_limit(self):
        """A run of many particles; below what the program takes to start, its libraries' own start fails, not the run."""
        large = ["--set", "bodies.left.spacing=0.16", "--set", "bodies.right.spacing=0.16", "--set", "stop.max_steps=60"]
        if not hasattr(self, "memory"):
            self.large_reference = self.work / "large"
            self.run(self.command(self.large_reference, *large), [0])
            self.memory = (self.least_memory([self.program, "--version"], [0]) + (1 << 21),
                           self.least_memory(self.command(self.work / "run", *large, "--overwrite"), [0]))
            print(f"  (address space: {self.memory[0] >> 10} KiB to start, {self.memory[1] >> 10} KiB to run)", flush=True)
        directory = self.new()
        limit = self.random.randint(self.memory[0], int(1.01 * self.memory[1]))
        process = self.start(self.command(directory, *large), limit)
        _, errors = process.communicate(timeout=60)
        # The OpenMP library ends the program by itself, with 1, where it finds no memory.
        expect(process.returncode in (0, 6) or process.returncode == 1 and "libgomp: Out of memory" in errors,
               f"exit code {process.returncode}; it said: {errors}")
        expect(process.returncode == 0 or "memory" in errors, f"does not say what happened: {errors}")
        reference, self.reference = self.reference, self.large_reference
        try:
            if not directory.exists():
                self.run(self.command(directory, *large), [0])
            self.go_on(directory, *large)
            self.same(directory)
        finally:
            self.reference = reference

    def interrupted_copy(self):
        """A finished run, put back to where its checkpoints are: what damage is done to."""
        directory = self.new()
        shutil.copytree(self.reference, directory)
        (directory / "summary.json").unlink()
        return directory, sorted(directory.glob("checkpoint-*.h5"))

    def refuses_newest(self, damage):
        directory, checkpoints = self.interrupted_copy()
        newest = checkpoints[-1]
        what = damage(newest, checkpoints)
        try:
            self.run([self.program, "info", newest, "--verify"], [5])
            self.run([self.program, "restart", newest, "--output", self.work / "other", "--overwrite"], [5])
            _, output, _ = self.run([self.program, "restart", directory], [0])
            expect("refused: " in output, "does not say that the newest checkpoint was refused")
            self.same(directory)
        except Failed as failed:
            raise Failed(f"{what}: {failed}")

    def flipped_bit(self):
        def damage(file, _):
            data = bytearray(file.read_bytes())
            header, rest = 512, len(data) - 512
            manifest = int.from_bytes(data[40:48], "little"), int.from_bytes(data[48:56], "little")
            region = self.random.choice(["header", "manifest", "HDF5 structure", "anywhere"])
            at = {"header": lambda: self.random.randrange(header),
                  "manifest": lambda: manifest[0] + self.random.randrange(manifest[1]),
                  "HDF5 structure": lambda: header + self.random.randrange(2048),
                  "anywhere": lambda: header + self.random.randrange(rest)}[region]()
            data[at] ^= 1 << self.random.randrange(8)
            file.write_bytes(data)
            return f"bit flipped in {region} at {at}"
        self.refuses_newest(damage)

    def truncated(self):
        def damage(file, _):
            size = self.random.randrange(file.stat().st_size)
            os.truncate(file, size)
            return f"cut to {size}"
        self.refuses_newest(damage)

    def foreign(self):
        def damage(file, checkpoints):
            kind = self.random.choice(["noise", "HDF5", "grown", "two halves"])
            old = file.read_bytes()
            size = self.random.randrange(1, 5000)
            data = {"noise": lambda: self.random.randbytes(size),
                    "HDF5": lambda: b"\x89HDF\r\n\x1a\n" + self.random.randbytes(size),
                    "grown": lambda: old + self.random.randbytes(size),
                    "two halves": lambda: checkpoints[0].read_bytes()[:len(old) // 2] + old[len(old) // 2:]}[kind]()
            file.write_bytes(data)
            return kind
        self.refuses_newest(damage)

    def two_runs(self):
        directory = self.new()
        first = self.start(self.command(directory))
        while not (directory / ".ogive-lock").exists() and first.poll() is None:
            time.sleep(0.0005)
        time.sleep(self.random.uniform(0, 0.7 * self.seconds))
        command = self.random.choice([self.command(directory, "--overwrite"), [self.program, "restart", directory]])
        code, _, errors = self.run(command, [4, 0])
        if first.poll() is None:
            expect(code == 4, "a second run was let in")
        expect(code == 0 or "another run" in errors or "holds no checkpoint" in errors, errors)
        self.finish(first, [0])
        self.same(directory)


KINDS = {
    "kill-stepping": (Bench.kill_stepping, "kill -9 at a random time"),
    "kill-writing": (Bench.kill_writing, "kill -9 before, within and after a system call that writes"),
    "kill-twice": (Bench.kill_twice, "kill -9 while writing, and again in the restart"),
    "disk-full": (Bench.disk_full, "disk or quota full from a call on"),
    "disk-error": (Bench.disk_error, "input/output error at a call, or from it on"),
    "read-only": (Bench.read_only, "directory read-only or forbidden from a call on"),
    "partial-writes": (Bench.partial_writes, "a write that is cut short or interrupted"),
    "signals": (Bench.signals, "SIGTERM, SIGINT, SIGHUP at a random time"),
    "clock-jumps": (Bench.clock_jumps, "clocks that jump by up to a year"),
    "memory-limit": (Bench.memory_limit, "address space limited to less than the run needs"),
    "bit-flip": (Bench.flipped_bit, "a bit flipped in each region of the newest checkpoint"),
    "truncated": (Bench.truncated, "the newest checkpoint cut off anywhere"),
    "foreign": (Bench.foreign, "another file in the place of the newest checkpoint"),
    "two-runs": (Bench.two_runs, "a second run or restart in the directory of a running one"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("shim", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=3)
    parser.add_argument("--seed", type=int, default=random.randrange(1 << 30))
    parser.add_argument("--only", default=",".join(KINDS), help=", ".join(KINDS))
    parser.add_argument("--work", type=pathlib.Path, default=None, help="a directory for the runs (default: a temporary one)")
    arguments = parser.parse_args()
    work = arguments.work or pathlib.Path(tempfile.mkdtemp(prefix="ogive-fault-"))
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    os.environ["OMP_NUM_THREADS"] = "1"
    failed_in_all = 0
    try:
        bench = Bench(arguments.program.resolve(), arguments.shim.resolve(), work.resolve(), arguments.seed)
        print(f"seed {arguments.seed}; a run takes {bench.seconds:.2f} s and {bench.calls} calls that write", flush=True)
        for name in arguments.only.split(","):
            method, text = KINDS[name]
            failed = 0
            for number in range(arguments.count):
                bench.random = random.Random(f"{arguments.seed} {name} {number}")
                try:
                    method(bench)
                except (Failed, OSError, subprocess.TimeoutExpired) as problem:
                    failed += 1
                    print(f"  {name} {number}: {problem}", flush=True)
            print(f"{name:15} tried {arguments.count:6d}  failed {failed:4d}  {text}", flush=True)
            failed_in_all += failed
    finally:
        if not arguments.work:
            shutil.rmtree(work, ignore_errors=True)
    return 1 if failed_in_all else 0


if __name__ == "__main__":
    sys.exit(main())
