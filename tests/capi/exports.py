#!/usr/bin/env python3
"""Fails where a library exports anything but the functions of its header, or needs a library that its hosts should not have.

    exports.py ROOT LIBOGIVE LIBOGIVE_IO LIBOGIVE_GEOMETRY
"""
import os
import re
import subprocess
import sys

root, core, io, geometry = sys.argv[1:]
sys.path.insert(0, os.path.join(root, "tools"))
from c_header import Header  # noqa: E402

ogive_h = Header(os.path.join(root, "capi/ogive.h"))
of_files = set(re.findall(r"\b(ogive_\w+)\(", ogive_h.text.split("files (link the library ogive_io)")[1]))
functions = {f.name for f in ogive_h.functions}
expected = {
    core: ("capi/exported_symbols.txt", functions - of_files),
    io: ("capi/exported_symbols_io.txt", functions & of_files),
    geometry: ("geometry/exported_symbols.txt",
               {f.name for f in Header(os.path.join(root, "geometry/ogive_geometry.h")).functions}),
}
# The C and C++ run times, OpenMP's, and what the library is for.
allowed = {core: r"lib(gomp|stdc\+\+|m|gcc_s|c)\.so", io: r"lib(ogive|hdf5\w*|stdc\+\+|m|gcc_s|c)\.so",
           geometry: r"lib(gmp|mpfr|stdc\+\+|m|gcc_s|c)\.so|ld-linux"}
faults = []
for library, (list_name, names) in expected.items():
    out = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    exported, versions = set(), {}
    for line in out.splitlines():
        kind, symbol = line.split()[-2:]
        name, _, version = symbol.partition("@")
        if kind == "A":
            continue  # the versions themselves
        exported.add(name)
        versions[name] = version.lstrip("@")
    with open(os.path.join(root, list_name), encoding="utf-8") as stream:
        blocks = re.findall(r"(\w+(?:\.\d+)+) \{(.*?)\}", stream.read(), flags=re.S)
    listed = {name: version for version, body in blocks for name in re.findall(r"(ogive_\w+);", body)}
    for what, a, b in (("exported, not in the header", exported, names), ("in the header, not exported", names, exported),
                       ("exported, not in " + list_name, exported, set(listed)),
                       ("in " + list_name + ", not exported", set(listed), exported)):
        faults += [f"{os.path.basename(library)}: {what}: {name}" for name in sorted(a - b)]
    faults += [f"{name}: version {versions[name]}, listed as {listed[name]}" for name in sorted(exported & set(listed))
               if versions[name] != listed[name]]
    dynamic = subprocess.run(["readelf", "-d", library], check=True, capture_output=True, text=True).stdout
    for needed in re.findall(r"NEEDED.*\[(.*?)\]", dynamic):
        if not re.match(allowed[library], needed):
            faults.append(f"{os.path.basename(library)} needs {needed}")
    if not re.search(r"SONAME.*\[" + re.escape(os.path.basename(library).split(".so")[0]) + r"\.so\.\d+\]", dynamic):
        faults.append(f"{os.path.basename(library)} has no soname with its major version")
    print(f"{os.path.basename(library)}: {len(exported)} functions")
if faults:
    sys.exit("\n".join(faults))
