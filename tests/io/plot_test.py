#!/usr/bin/python3
"""The plotting tools on a small run of made-up files: pictures where they should be, clear refusals elsewhere.

  plot_test.py TOOLS_DIRECTORY
"""

import json
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

TOOLS = sys.argv[1]


def write_run(directory):
    x, y, z = np.meshgrid(np.arange(-4.5, 5), np.arange(0.5, 3), np.arange(0.5, 3), indexing="ij")
    plate = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    ball = np.array([[0.0, 0.5, -1.0], [0.0, 0.5, -2.0]])
    for number in range(3):
        with h5py.File(os.path.join(directory, f"particles-{number:05d}.h5"), "w", userblock_size=512) as file:
            file.attrs["format"] = "ogive-particles"
            file.attrs["time"] = 0.01 * number
            for name, position, speed in (("plate", plate, 0.0), ("ball", ball, 100.0 - number)):
                group = file.create_group(name)
                group.attrs["name"] = name
                count = len(position)
                group["position"] = position + [0, 0, 0.01 * speed * number]
                group["velocity"] = np.tile([0, 0, speed], (count, 1))
                group["mass"] = group["volume"] = np.ones(count)
                group["stress"] = np.zeros((count, 6))
                if name == "plate":
                    group["plastic_strain"] = np.linspace(0, 1, count)
                    group["failed"] = np.zeros(count)
    with open(os.path.join(directory, "summary.json"), "w", encoding="utf-8") as file:
        json.dump({"title": "a test", "units": {"length": "mm", "time": "ms", "mass": "g"}}, file)
    with open(os.path.join(directory, "history.csv"), "w", encoding="utf-8") as file:
        file.write("step,time,kinetic,internal,total,residual,plate.speed,ball.speed\n"
                   "0,0,10,0,10,0,0,100\n1,0.01,8,2,10,0,1,99\n2,0.02,7,3,10,0,1,98\n")


def tool(name, *arguments):
    return subprocess.run(["/usr/bin/python3", os.path.join(TOOLS, name), *arguments], capture_output=True, text=True,
                          check=False)


def expect(condition, what):
    if not condition:
        sys.exit(f"failed: {what}")


def is_picture(name):
    with open(name, "rb") as file:
        return file.read(8) == b"\x89PNG\r\n\x1a\n"


def main():
    with tempfile.TemporaryDirectory() as run:
        write_run(run)
        output = os.path.join(run, "out.png")
        done = tool("plot_section.py", run, "-o", output)
        expect(done.returncode == 0 and is_picture(output), f"section: {done.stderr}")
        done = tool("plot_section.py", run, "-o", os.path.join(run, "one.png"), "--separate", "--field", "stress.xx",
                    "--plane", "z=1.5", "--mesh-width", "1")
        expect(done.returncode == 0 and is_picture(os.path.join(run, "one-00002.png")), f"separate: {done.stderr}")
        done = tool("plot_history.py", run, "-o", output, "--reference", "experiment=97")
        expect(done.returncode == 0 and is_picture(output), f"history: {done.stderr}")

        for name, arguments, reason in (
                ("plot_section.py", [run, "--field", "nothing"], "no body has the field 'nothing'"),
                ("plot_section.py", [run, "--field", "stress"], "choose one of stress.xx"),
                ("plot_section.py", [run, "--plane", "y"], "expected for example y=0"),
                ("plot_section.py", [run, "--plane", "y=99"], "no particle is near y=99"),
                ("plot_section.py", [os.path.join(run, "missing.h5")], "missing.h5"),
                ("plot_section.py", [os.path.join(run, "history.csv")], "history.csv"),
                ("plot_history.py", [os.path.join(run, "missing")], "missing"),
                ("plot_history.py", [run, "--body", "rod"], "has no column 'rod.speed'"),
                ("plot_history.py", [os.path.join(run, "summary.json")], "expected a heading")):
            done = tool(name, *arguments, "-o", os.path.join(run, "refused.png"))
            expect(done.returncode == 1 and reason in done.stderr and "Traceback" not in done.stderr,
                   f"{name} {arguments}: {done.returncode} {done.stderr}")
        expect(not os.path.exists(os.path.join(run, "refused.png")), "a refusal leaves no picture")


main()
