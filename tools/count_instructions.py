#!/usr/bin/env python3
"""Instructions that a fixed small case takes in the engine, against the recorded figure: fails if they are 5 % more.

  tools/count_instructions.py PROGRAM CASE [--compiler "GNU 12.2.0"] [--record]

PROGRAM is ogive_small_impact of a release build. What is counted is ogive_world_advance alone, by valgrind's callgrind, with the
kernels of x86-64-v3, which valgrind can run whatever the machine is. Figures are in tests/data/instruction_counts.json and
hold for the compiler named there; with another one, or without valgrind, the test is skipped (exit code 77). --record
writes the figure instead of comparing.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

RECORD = os.path.join(os.path.dirname(__file__), "..", "tests", "data", "instruction_counts.json")
ALLOWED = 1.05
SKIPPED = 77


def count(program, case):
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run(
            ["valgrind", "--tool=callgrind", "--toggle-collect=ogive_world_advance",
             f"--callgrind-out-file={folder}/out", program, case],
            env={**os.environ, "OGIVE_ISA": "x86-64-v3", "OMP_NUM_THREADS": "1"}, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", result.stderr)
    if result.returncode != 0 or not found or int(found[1]) == 0:
        sys.exit(f"count_instructions.py: no count from {program} {case}:\n{result.stderr[-2000:]}")
    return int(found[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("case")
    parser.add_argument("--compiler", default="")
    parser.add_argument("--record", action="store_true")
    arguments = parser.parse_args()
    try:
        with open(RECORD, encoding="utf-8") as file:
            record = json.load(file)
    except OSError:
        record = {"compiler": arguments.compiler, "instructions": {}}
    if not shutil.which("valgrind"):
        print("valgrind is not installed")
        sys.exit(SKIPPED)
    if arguments.compiler != record["compiler"] and not arguments.record:
        print(f"figures are for {record['compiler']}, this is {arguments.compiler}")
        sys.exit(SKIPPED)
    counted = count(arguments.program, arguments.case)
    if arguments.record:
        record["compiler"] = arguments.compiler
        record["instructions"][arguments.case] = counted
        with open(RECORD, "w", encoding="utf-8") as file:
            json.dump(record, file, indent=2)
            file.write("\n")
        print(f"{arguments.case}: {counted} recorded")
        return
    recorded = record["instructions"][arguments.case]
    print(f"{arguments.case}: {counted} instructions, recorded {recorded}: {100 * (counted / recorded - 1):+.2f} %")
    if counted > ALLOWED * recorded:
        sys.exit("more than 5 % above the record: find out why, or record the new figure in the commit that justifies it")
    if counted < recorded / ALLOWED:
        print("more than 5 % below the record: worth recording (--record)")


if __name__ == "__main__":
    main()
