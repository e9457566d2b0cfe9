#!/usr/bin/env python3
"""Builds the engine within an outside project by add_subdirectory, and runs its host.

    subdirectory.py ROOT SCRATCH
"""
import os
import sys

from common import fresh, run, speed

root, scratch = map(os.path.abspath, sys.argv[1:])
fresh(scratch)
run("cmake", "-S", os.path.join(root, "tests/consumer/subdirectory"), "-B", scratch, f"-DOGIVE_SOURCE={root}",
    "-DCMAKE_BUILD_TYPE=Debug")
run("cmake", "--build", scratch, "--target", "host", "-j", "2")
print(speed(run(os.path.join(scratch, "host"))))
