#!/usr/bin/env python3
"""Runs two programs; they must print the same lines, and some."""
import subprocess
import sys

first, second = (subprocess.run([program], check=True, capture_output=True, text=True).stdout.split("\n")
                 for program in sys.argv[1:3])
for a, b in zip(first, second):
    if " ".join(a.split()) != " ".join(b.split()):
        sys.exit(f"differ: {a!r} and {b!r}")
if len(first) != len(second) or len(first) < 100:
    sys.exit(f"{len(first)} and {len(second)} lines")
print(f"{len(first)} lines are the same")
