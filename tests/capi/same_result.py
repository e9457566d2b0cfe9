#!/usr/bin/env python3
"""Runs the coarse thick plate by the program ogive and by host programs: the residual velocities must be equal to the bit.

    same_result.py SCENE_DIRECTORY SCRATCH OGIVE HOST...
"""
import json
import os
import re
import subprocess
import sys

scene, scratch, program, *hosts = sys.argv[1:]
results = os.path.join(scratch, "thick_plate")
subprocess.run([program, "run", os.path.join(scene, "scene.toml"), "--output", results, "--overwrite",
                "--set", "grid.cell_size=4", "--set", "bodies.plate.spacing=2",
                "--set", "bodies.rod.spacing=[1.24,1.24,2]", "--set", "output.particle_interval=0",
                "--set", "output.checkpoint_steps=0"], check=True, stdout=subprocess.DEVNULL)
with open(os.path.join(results, "summary.json"), encoding="utf-8") as stream:
    expected = json.load(stream)["results"]["residual_velocity"]
if not 300 < expected < 575:
    sys.exit(f"the program's residual velocity is {expected!r}: the rod has not perforated the plate")
for host in hosts:
    text = subprocess.run([host, os.path.join(scene, "rod.stl")], check=True, capture_output=True, text=True).stdout
    value = float(re.search(r"residual velocity\s+(\S+) m/s", text).group(1))
    print(f"{os.path.basename(host)}: {value!r}, ogive: {expected!r}")
    if value != expected:
        sys.exit("they differ")
