#!/usr/bin/env python3
"""Compares a library with the recorded ABI of an older one. Functions may have come, and fields at the end of structs whose
size their users state; anything else fails.

    abi.py ABIDIFF ROOT RECORD LIBRARY

A record is made of a library with debug information by
    abidw --exported-interfaces-only --headers-dir capi --headers-dir geometry --drop-private-types --no-corpus-path \\
          --no-comp-dir-path --no-show-locs --no-elf-needed LIBRARY
"""
import os
import re
import subprocess
import sys

abidiff, root, record, library = sys.argv[1:]
suppressions = os.path.join(root, "tests/capi/abi/suppressions.txt")
result = subprocess.run([abidiff, "--exported-interfaces-only", "--no-added-syms", "--no-show-locs",
                         "--suppressions", suppressions, record, library], capture_output=True, text=True)
print(result.stdout, result.stderr)
with open(record, encoding="utf-8") as stream:
    functions = len(re.findall("<elf-symbol ", stream.read()))
print(f"{functions} recorded functions, status {result.returncode}")
if result.returncode != 0 or functions < 6:
    sys.exit(1)
