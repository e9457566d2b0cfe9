#!/usr/bin/env python3
"""Writes layout.c and layout.f90, which print the size of each struct of the headers and the offset of each of its fields.

    layout.py ROOT DIRECTORY
"""
import os
import sys

root, directory = sys.argv[1:3]
sys.path.insert(0, os.path.join(root, "tools"))
from c_header import Header  # noqa: E402

structs = {}
for header in ("capi/ogive.h", "geometry/ogive_geometry.h"):
    structs.update(Header(os.path.join(root, header)).structs)
c = ["#include <stddef.h>", "#include <stdio.h>", "#include <ogive_geometry.h>", "int main(void) {"]
f = ["program layout", "  use ogive_c", "  use ogive_geometry_c", "  implicit none"]
f += [f"  type({name}), target :: x{i}" for i, name in enumerate(structs)]
for i, (name, fields) in enumerate(structs.items()):
    c.append(f'  printf("{name} %zu\\n", sizeof({name}));')
    f.append(f'  print "(a, i0)", "{name} ", c_sizeof(x{i})')
    for field in fields:
        c.append(f'  printf("{name}.{field.name} %zu\\n", offsetof({name}, {field.name}));')
        f.append(f'  print "(a, i0)", "{name}.{field.name} ", offset(c_loc(x{i}), c_loc(x{i}%{field.name}))')
c += ["  return 0;", "}", ""]
f += ["contains", "  function offset(from, to)", "    type(c_ptr), intent(in) :: from, to",
      "    integer(c_intptr_t) :: offset", "    offset = transfer(to, offset) - transfer(from, offset)", "  end function",
      "end program", ""]
os.makedirs(directory, exist_ok=True)
for name, lines in (("layout.c", c), ("layout.f90", f)):
    with open(os.path.join(directory, name), "w", encoding="utf-8") as stream:
        stream.write("\n".join(lines))
