#!/usr/bin/env python3
"""Compares the headers with those kept of an older version: every constant, field and function of then is there as it was,
fields in their places; what is new comes after.

    header_grew.py ROOT DIRECTORY_OF_OLD_HEADERS
"""
import os
import sys

root, old_directory = sys.argv[1:]
sys.path.insert(0, os.path.join(root, "tools"))
from c_header import Header  # noqa: E402

faults = []
for name, path in (("ogive.h", "capi/ogive.h"), ("ogive_geometry.h", "geometry/ogive_geometry.h")):
    old, new = Header(os.path.join(old_directory, name)), Header(os.path.join(root, path))
    values = dict(new.constants)
    for constant, value in old.constants:
        if not constant.startswith("OGIVE_VERSION_") and values.get(constant) != value:
            faults.append(f"{constant} was {value}, is {values.get(constant)}")
    for struct, fields in old.structs.items():
        kept = [repr(field) for field in new.structs.get(struct, [])[:len(fields)]]
        if kept != [repr(field) for field in fields]:
            faults.append(f"{struct} does not begin with the fields that it had")
        id_of_one_number = len(fields) == 1
        if len(new.structs.get(struct, [])) > len(fields) and (id_of_one_number or fields[0].name != "struct_size"):
            faults.append(f"{struct} has grown and its users do not state its size")
    signatures = {f.name: (f.result, [repr(a) for a in f.arguments]) for f in new.functions}
    for function in old.functions:
        if signatures.get(function.name) != (function.result, [repr(a) for a in function.arguments]):
            faults.append(f"{function.name} is not what it was")
    print(f"{name}: {len(old.constants)} constants, {len(old.structs)} structs, {len(old.functions)} functions are kept")
    if len(old.functions) < 10:
        faults.append(f"{name}: too few functions were found")
if faults:
    sys.exit("\n".join(faults))
