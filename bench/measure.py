#!/usr/bin/python3
"""Measures the engine's speed on this machine and writes docs/performance.md, its data and its charts anew.

  bench/measure.py [--build build/bench] [--work DIR] [--quick] [--draw-only]

BUILD is a release build with OGIVE_BENCH=ON (cmake --preset bench && cmake --build --preset bench). Results go to
docs/data/performance.json, charts to docs/images/performance_*.png, tables between the markers of docs/performance.md.
--quick leaves out the whole run and the largest sizes and runs each case once, not three times with the best kept;
--draw-only draws what an earlier call measured.

One thread is measured in processor time, user and system together, of the steps with all their output: on a machine that others
use it varies by a tenth where wall time doubles. Two threads can be measured in wall time only, and are not where other programs
keep the machine busy. The machine's own limits are measured before and after, so that a disturbed measurement shows.
"""

import argparse
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, os.path.join(ROOT, "tools"))
from validation_table import replace_block  # noqa: E402
PLATE = os.path.join(ROOT, "examples", "scenes", "thick_plate", "scene.toml")
BLOCK = os.path.join(ROOT, "bench", "block.toml")
DATA = os.path.join(ROOT, "docs", "data", "performance.json")
PAGE = os.path.join(ROOT, "docs", "performance.md")
NO_FILES = ["output.particle_interval=0", "output.checkpoint_steps=0"]  # for runs of few steps
FLIP = ["numerics.shape_function=linear", "numerics.transfer=flip", "numerics.time_step_factor=0.4"]


def computed(summary):
    return summary["particle_steps"] - summary["resting_particle_steps"]


class Bench:
    def __init__(self, build, work, repeats):
        self.bin = os.path.join(build, "bin")
        self.work = work
        self.repeats = repeats

    def limits(self):
        out = subprocess.run([os.path.join(self.bin, "ogive_limits"), str(os.cpu_count())], check=True,
                             capture_output=True, text=True).stdout
        return json.loads(out)

    def phases(self):
        out = subprocess.run([os.path.join(self.bin, "ogive_bench"), "--benchmark_format=json",
                              "--benchmark_min_time=0.1", "--benchmark_repetitions=3",
                              "--benchmark_report_aggregates_only=false"],
                             check=True, capture_output=True, text=True).stdout
        best = {}
        for entry in json.loads(out)["benchmarks"]:
            if entry.get("run_type") != "iteration":
                continue
            ns = entry["ns"]
            if entry["name"] not in best or ns < best[entry["name"]]["ns"]:
                best[entry["name"]] = {"ns": ns, "bytes": entry["bytes"], "operations": entry.get("operations", 0)}
        return best

    def runs(self, isa):
        """Whether this processor and this build have an instruction set."""
        return subprocess.run([os.path.join(self.bin, "ogive"), "check", BLOCK, "--set", "parameters.L=4"], capture_output=True,
                              env=dict(os.environ, OGIVE_ISA=isa)).returncode == 0

    def once(self, scene, settings, threads, isa, until):
        """Summary and wall seconds of one run."""
        command = [os.path.join(self.bin, "ogive"), "run", scene, "--output", os.path.join(self.work, "run"),
                   "--overwrite", "--threads", str(threads)]
        for setting in settings:
            command += ["--set", setting]
        if until:
            command += ["--until", str(until)]
        start = time.monotonic()
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              env=dict(os.environ, **({"OGIVE_ISA": isa} if isa else {})))
        if done.returncode != 0:
            sys.exit(f"measure.py: {' '.join(command)} ended with {done.returncode}")
        with open(os.path.join(self.work, "run", "summary.json"), encoding="utf-8") as file:
            return json.load(file), time.monotonic() - start

    def best_of(self, cases):
        """For {key: case}, a case being the arguments of once() by name: the best of some runs of each, with nanoseconds a
        particle-step and what summary.json tells. The runs go round all cases: what disturbs the machine for a minute does not
        hit all runs of one."""
        best = {}
        for turn in range(self.repeats):
            for key, case in cases.items():
                if turn > 0 and case.get("once"):
                    continue
                arguments = {"settings": (), "threads": 1, "isa": None, "until": None, **case}
                arguments.pop("once", None)
                summary, wall = self.once(**arguments)
                # The cost of particles, not of those that are at rest and left out; nor of the start.
                steps, seconds = computed(summary), summary["cpu_seconds"]["stepping"] + summary["cpu_seconds"]["output"]
                wall_ns = 1e9 * summary["wall_seconds"] / steps
                got = {"ns": 1e9 * seconds / steps if arguments["threads"] == 1 else wall_ns, "wall_ns": wall_ns,
                       "particles": summary["particles"], "steps": summary["steps"], "seconds": summary["wall_seconds"],
                       "cpu": seconds, "start_cpu": summary["cpu_seconds"]["start"],
                       "start_seconds": wall - summary["wall_seconds"], "bytes": summary["peak_memory_bytes"]}
                if key not in best or got["ns"] < best[key]["ns"]:
                    best[key] = got
        return best


def measure(bench, quick):
    data = {"machine": machine(), "limits_before": bench.limits()}
    say = lambda text: print(text, flush=True)
    say("phases")
    data["phases"] = bench.phases()
    early = 0.022
    busy = os.getloadavg()[0] > 1.5

    settings = {
        "trilinear, FLIP": FLIP,
        "trilinear, affine FLIP": FLIP[:1] + FLIP[2:],
        "trilinear, affine FLIP, stress last": FLIP[:1] + FLIP[2:] + ["numerics.update_order=stress_last"],
        "B-spline, FLIP": ["numerics.transfer=flip"],
        "B-spline, affine FLIP (the scene's)": [],
        "B-spline, affine FLIP, stress last": ["numerics.update_order=stress_last"],
        "B-spline, APIC": ["numerics.transfer=apic"],
        "GIMP, FLIP": ["numerics.shape_function=gimp", "numerics.transfer=flip"],
    }
    both = ("trilinear, FLIP", "B-spline, affine FLIP (the scene's)")
    full = ["grid.faces.y_min=free", "grid.lower=[-100,-60,-120]"]
    features = {
        "one velocity field (no contact)": FLIP + ["contact.method=single_field"],
        "friction 0.1": FLIP + ["contact.friction=0.1"],
        "first contact method": FLIP + ["contact.method=huang_first"],
        "no heating": FLIP + ["materials.aluminium.johnson_cook.m=0"],
        "no failure": FLIP + ["materials.aluminium.failure.plastic_strain=1e9"],
        "bulk viscosity": FLIP + ["materials.aluminium.viscosity={linear=0.06,quadratic=1.5}"],
        "APIC": FLIP[:1] + ["numerics.transfer=apic"],
        "XPIC(2)": FLIP[:1] + ["numerics.transfer=xpic"] + FLIP[2:],
        "full model, no symmetry": FLIP + full,
    }
    cases = {("settings", name): {"scene": PLATE, "settings": values, "until": early} for name, values in settings.items()}
    if not busy:
        cases |= {("two_threads", name): {"scene": PLATE, "settings": settings[name], "threads": 2, "until": early} for name in both}
    cases |= {("features", name): {"scene": PLATE, "settings": values, "until": early} for name, values in features.items()}
    cases |= {("isa", isa, name): {"scene": PLATE, "settings": settings[name], "isa": isa, "until": early}
              for isa in ("x86-64-v4", "x86-64-v3", "x86-64-v2", "generic") if bench.runs(isa) for name in both}
    # The same block with ten times the room around it in each direction.
    cases |= {("empty", str(room)): {"scene": BLOCK, "settings": ["parameters.L=60", f"parameters.room={room}"] + FLIP, "until": 0.03}
              for room in (1, 10)}
    for edge, until in ((22, 0.2), (46, 0.03), (100, 0.004), (126, 0.003)) + (() if quick else ((216, 0.002),)):
        for name, values in (("trilinear, FLIP", FLIP), ("B-spline, affine FLIP", [])):
            cases["growth", str(edge**3), name] = {"scene": BLOCK, "settings": [f"parameters.L={edge}"] + NO_FILES + values,
                                                   "until": until, "once": edge > 200}
    for name, steps in (("many", 10), ("none", 1000000)):
        cases["checkpoints", name] = {"scene": PLATE, "settings": [f"output.checkpoint_steps={steps}"], "until": early}
    if not quick:
        whole = FLIP + ["contact.detection=shared_node"]
        cases |= {("whole", "trilinear, FLIP, 1 thread"): {"scene": PLATE, "settings": whole},
                  ("whole", "trilinear, FLIP, 2 threads"): {"scene": PLATE, "settings": whole, "threads": 2},
                  ("whole", "B-spline, affine FLIP, 1 thread"): {"scene": PLATE},
                  ("whole", "B-spline, affine FLIP, 2 threads"): {"scene": PLATE, "threads": 2}}
    say(f"{len(cases)} cases")
    for key, got in bench.best_of(cases).items():
        place = data
        for part in key[:-1]:
            place = place.setdefault(part, {})
        place[key[-1]] = got
    data.setdefault("two_threads", {})
    data["features"] = {"as above, trilinear, FLIP": data["settings"]["trilinear, FLIP"], **data["features"],
                        "affine velocities": data["settings"]["trilinear, affine FLIP"],
                        "B-spline": data["settings"]["B-spline, FLIP"], "GIMP": data["settings"]["GIMP, FLIP"]}

    say("set-up")
    start = time.monotonic()
    mesh = os.path.join(ROOT, "examples", "scenes", "thick_plate", "rod.stl")
    subprocess.run([os.path.join(bench.bin, "ogive"), "voxelise", mesh, "--spacing", "0.5", "-o",
                    os.path.join(bench.work, "rod.csv")], check=True, capture_output=True)
    data["voxelise_seconds"] = time.monotonic() - start
    data["start_seconds"], data["start_cpu"] = (data["growth"]["2000376"]["trilinear, FLIP"][key]
                                                for key in ("start_seconds", "start_cpu"))
    many, none = data["checkpoints"]["many"], data["checkpoints"]["none"]
    seconds = (many["cpu"] - none["cpu"]) / (many["steps"] // 10)
    data["checkpoint"] = {"seconds": seconds, "share_percent": 100 * seconds / (none["cpu"] / none["steps"] * 500)}
    data["limits_after"] = bench.limits()
    return data


def machine():
    name = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            text = file.read()
        name = re.search(r"model name\s*: (.*)", text)[1]
        name += ", family %s model %s" % tuple(re.search(rf"{key}\t+: (\d+)", text)[1] for key in ("cpu family", "model"))
    except (OSError, TypeError):
        pass
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    return {"processor": name, "cores": os.cpu_count(), "compiler": compiler, "load": os.getloadavg()[0]}


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def speed(entry):
    return f"{1e3 / entry['ns']:.1f}"


def tables(data):
    limits = data["limits_before"], data["limits_after"]
    both = lambda key, unit: " / ".join(f"{x[key] / unit:.1f}" for x in limits)
    m = data["machine"]
    out = {}
    out["machine"] = (
        f"{m['processor']}, {m['cores']} cores; {m['compiler']}; load of other programs before the start {m['load']:.1f}. Its "
        f"own limits before and after: clock {both('clock_hz', 1e9)} GHz, fused multiply-adds {both('flops', 1e9)} Gflop/s "
        f"a core, copying {both('copy_bytes_per_second', 1e9)} GB/s (one core), "
        f"{both('copy_bytes_per_second_all', 1e9)} GB/s (all).")
    out["settings"] = table(
        ["settings", "ns a particle-step", "million a second", "two threads", "bytes a particle (process)"],
        [[name, f"{e['ns']:.1f}", speed(e),
          f"{e['wall_ns'] / data['two_threads'][name]['ns']:.2f}x" if name in data["two_threads"] else "",
          f"{e['bytes'] / e['particles']:.0f}"] for name, e in data["settings"].items()])
    if "whole" in data:
        out["whole"] = table(["whole run, V0 = 575 m/s", "steps", "seconds", "million a second"],
                             [[n, e["steps"], f"{e['seconds']:.1f}", speed(e)] for n, e in data["whole"].items()])
    base = data["settings"]["trilinear, FLIP"]["ns"]
    out["features"] = table(["thick plate, trilinear FLIP", "ns", "difference"],
                            [[n, f"{e['ns']:.1f}", f"{e['ns'] - base:+.1f}"] for n, e in data["features"].items()])
    best = next(iter(data["isa"].values()))
    out["isa"] = table(["instruction set"] + list(best),
                       [[isa] + [f"{speed(e[n])} ({best[n]['ns'] / e[n]['ns']:.2f})" for n in best]
                        for isa, e in data["isa"].items()])
    out["growth"] = table(["particles"] + ["ns, " + n for n in next(iter(data["growth"].values()))] + ["bytes a particle"],
                          [[f"{int(n):,}"] + [f"{e['ns']:.1f}" for e in row.values()] +
                           [" / ".join(f"{e['bytes'] / int(n):.0f}" for e in row.values())]
                           for n, row in data["growth"].items()])
    near, far = data["empty"]["1"], data["empty"]["10"]
    out["other"] = "\n".join([
        f"- Domain ten times larger in each direction: time {100 * (far['ns'] / near['ns'] - 1):+.1f} %, memory "
        f"{100 * (far['bytes'] / near['bytes'] - 1):+.1f} %.",
        f"- Voxelising the rod at 0.5 mm {data['voxelise_seconds']:.2f} s; starting a run of two million "
        f"particles {data['start_seconds']:.2f} s ({data['start_cpu']:.2f} s of processor time).",
        f"- A checkpoint of the thick plate takes {data['checkpoint']['seconds']:.3f} s of processor time; at one in 500 steps "
        f"{data['checkpoint']['share_percent']:.1f} % of the run."])
    copy, hz = limits[0]["copy_bytes_per_second"], limits[0]["clock_hz"]
    peak = limits[0]["flops"]
    rows = []
    for name, e in data["phases"].items():
        if not name.endswith("/1M"):
            continue
        small = data["phases"][name[:-2] + "20k"]
        rows.append([name[:-3], f"{small['ns']:.1f}", f"{small['ns'] * hz * 1e-9:.0f}", f"{e['ns']:.1f}", f"{e['bytes']:.0f}",
                     f"{100 * e['bytes'] / e['ns'] * 1e9 / copy:.0f} %", f"{e['operations']:.0f}" if e.get("operations") else "",
                     f"{100 * small['operations'] / small['ns'] * 1e9 / peak:.0f} %" if e.get("operations") else ""])
    out["phases"] = table(["phase", "ns, 20 thousand", "cycles", "ns, a million", "bytes", "of copying's rate",
                           "operations", "of peak, 20 thousand"], rows)
    return out


def draw(data):
    import plot_common
    plt = plot_common.plt
    images = os.path.join(ROOT, "docs", "images")
    figure, axes = plt.subplots(figsize=(6, 3))
    for name in next(iter(data["growth"].values())):
        axes.semilogx([int(n) for n in data["growth"]], [1e3 / row[name]["ns"] for row in data["growth"].values()], "o-",
                      label=name)
    axes.set(xlabel="particles", ylabel="million particle-steps a second, one thread", ylim=(0, None))
    axes.legend()
    figure.savefig(os.path.join(images, "performance_growth.png"), dpi=110)
    figure, axes = plt.subplots(figsize=(6, 3.2))
    parts = [("map_momentum", "to the grid"), ("update_stress", "strain, stress, force"), ("update_particles", "to the particles")]
    bars = ["linear/flip", "linear/affine", "bspline/flip", "bspline/affine"]
    left = [0.0] * len(bars)
    for phase, label in parts:
        widths = []
        for bar in bars:
            shape, transfer = bar.split("/")
            key = (f"update_stress/{shape}/johnson_cook_thermal+mie_gruneisen/1M" if phase == "update_stress"
                   else f"{phase}/{shape}/{transfer}/1M")
            widths.append(data["phases"][key]["ns"])
        axes.barh(bars, widths, left=left, label=label)
        left = [a + b for a, b in zip(left, widths)]
    axes.invert_yaxis()
    axes.set(xlabel="ns a particle-step, a million particles, one thread, elastic state")
    axes.legend()
    figure.savefig(os.path.join(images, "performance_phases.png"), dpi=110)


def write_page(data):
    for name, text in tables(data).items():
        replace_block(PAGE, name, text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build", "bench"))
    parser.add_argument("--work", help="directory for the runs (default: a temporary one)")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--draw-only", action="store_true")
    arguments = parser.parse_args()
    if arguments.draw_only:
        with open(DATA, encoding="utf-8") as file:
            data = json.load(file)
    else:
        work = arguments.work or tempfile.mkdtemp(prefix="ogive-bench-")
        os.makedirs(work, exist_ok=True)
        try:
            data = measure(Bench(arguments.build, work, 1 if arguments.quick else 3), arguments.quick)
        finally:
            if not arguments.work:
                shutil.rmtree(work)
        with open(DATA, "w", encoding="utf-8") as file:
            json.dump(data, file, indent=1)
            file.write("\n")
    draw(data)
    write_page(data)


if __name__ == "__main__":
    main()
