#!/usr/bin/env python3
"""Builds the HTML manual of the C headers; every declaration must be described, and Doxygen must have nothing to say.

    manual.py DOXYGEN ROOT OUTPUT
"""
import os
import subprocess
import sys

doxygen, root, output = sys.argv[1:]
with open(os.path.join(root, "docs/Doxyfile"), encoding="utf-8") as stream:
    settings = stream.read() + f"\nOUTPUT_DIRECTORY = {output}\n"
os.makedirs(output, exist_ok=True)
result = subprocess.run([doxygen, "-"], input=settings, cwd=root, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
print(result.stdout)
page = os.path.join(output, "html/ogive_8h.html")
with open(page, encoding="utf-8") as stream:
    names = stream.read()
if result.returncode != 0 or result.stdout.strip() or "ogive_world_advance" not in names:
    sys.exit(1)
