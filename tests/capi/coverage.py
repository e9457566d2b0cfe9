#!/usr/bin/env python3
"""Fails where a function of the C headers is called by no test with good, or by none with bad arguments.

    coverage.py ROOT
"""
import os
import re
import sys

root = sys.argv[1]
sys.path.insert(0, os.path.join(root, "tools"))
from c_header import Header  # noqa: E402

functions = [f for h in ("capi/ogive.h", "geometry/ogive_geometry.h") for f in Header(os.path.join(root, h)).functions]
failed = False
for file in ("good_test.c", "bad_test.c"):
    with open(os.path.join(root, "tests/capi", file), encoding="utf-8") as stream:
        text = stream.read()
    with open(os.path.join(root, "tests/capi/small_world.h"), encoding="utf-8") as stream:
        text += stream.read() if file == "good_test.c" else ""
    text += "".join(f" {name}_init(" for name in re.findall(r"INIT_KEEPS_TO_ITS_SIZE\((ogive_\w+)\);", text))
    for function in functions:
        if file == "bad_test.c" and not function.arguments:
            continue  # nothing can be wrong
        if not re.search(rf"\b{function.name}\(", text):
            print(f"{file} does not call {function.name}")
            failed = True
print(f"{len(functions)} functions")
sys.exit(failed)
