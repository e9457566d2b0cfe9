#!/usr/bin/env python3
"""Compiles and runs every piece of code of docs/embedding.md and README.md in C or Fortran.

    snippets.py ROOT BUILD SCRATCH

A block is a whole program, or (```c fragment, ```fortran fragment) a part of one that has a prepared world; ```c declaration stands
before the fragments.
"""
import os
import re
import sys

root, build, scratch = map(os.path.abspath, sys.argv[1:])
sys.path.insert(0, os.path.join(root, "tests/consumer"))
from common import fresh, run  # noqa: E402

fresh(scratch)
library = os.path.join(build, "lib")
link = [f"-L{library}", f"-Wl,-rpath,{library}"]
c_flags = ["-std=c11", "-Wall", "-Wextra", "-Werror", f"-I{root}/capi", f"-I{root}/geometry"]
fortran_flags = ["-std=f2008", "-Wall", "-Werror", f"-I{build}/fortran"]

with open(os.path.join(root, "docs/embedding.md"), encoding="utf-8") as stream:
    blocks = re.findall(r"^```(c|fortran)(?: (\w+))?\n(.*?)^```$", stream.read(), flags=re.S | re.M)
with open(os.path.join(root, "README.md"), encoding="utf-8") as stream:
    blocks += re.findall(r"^```(c)(?: (\w+))?\n(.*?)^```$", stream.read(), flags=re.S | re.M)
first = {language: next(code for kind, use, code in blocks if kind == language and not use) for language in ("c", "fortran")}
declarations = "".join(code for language, use, code in blocks if use == "declaration")


def c_fragment(code):
    """The first program with the fragment between its preparing and its advance."""
    head, tail = first["c"].split("  if (ogive_world_prepare", 1)
    head = head.replace("/* A steel ball", declarations + "\n/* A steel ball")
    body = """  ogive_load_def load_def;
  ogive_load_id load;
  ogive_world* fresh_world = NULL;
  ogive_load_def_init(&load_def, sizeof load_def);
  if (ogive_load_add(world, &load_def, &load) != OGIVE_OK || ogive_world_create(&fresh_world) != OGIVE_OK) return 1;
  (void)look_in;
  if (ogive_world_prepare(world) != OGIVE_OK) return 1;
  {
""" + code + """
  }
  ogive_world_destroy(fresh_world);
  (void)result;
  ogive_world_destroy(world);
  return 0;
}
"""
    del tail
    return head + body


def fortran_fragment(code):
    head, tail = first["fortran"].split("  call simulation%destroy()", 1)
    return head + "  block\n" + code + "  end block\n  call simulation%destroy()" + tail


counts = {"c": 0, "fortran": 0}
for number, (language, use, code) in enumerate(blocks):
    if use == "declaration":
        continue
    counts[language] += 1
    suffix = {"c": "c", "fortran": "f90"}[language]
    source = os.path.join(scratch, f"snippet{number}.{suffix}")
    text = code if not use else c_fragment(code) if language == "c" else fortran_fragment(code)
    with open(source, "w", encoding="utf-8") as stream:
        stream.write(text)
    program = os.path.join(scratch, f"snippet{number}")
    if language == "c":
        run("cc", *c_flags, source, "-o", program, *link, "-logive_io", "-logive_geometry", "-logive", "-lm")
    else:
        run("gfortran", *fortran_flags, source, "-o", program, *link, "-logive_fortran", "-logive")
    print(os.path.basename(source) + ":", run(program, cwd=scratch).strip())
print(counts)
if counts["c"] < 7 or counts["fortran"] < 2:
    sys.exit("pieces of code were not found")
