#!/usr/bin/env python3
"""Writes the Fortran interfaces of the C headers: capi/fortran/ogive_c.f90 and ogive_geometry_c.f90.

    tools/fortran_bindings.py [--check]

--check writes nothing and fails where a file is not what the headers say (a test runs it).
"""
import os
import sys

from c_header import Header

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
NUMBERS = {"int32_t": "integer(c_int32_t)", "uint32_t": "integer(c_int32_t)", "int64_t": "integer(c_int64_t)",
           "double": "real(c_double)", "size_t": "integer(c_size_t)", "ogive_status": "integer(c_int32_t)"}
OPAQUE = {"ogive_world", "ogive_mesh"}
CALLBACKS = {"ogive_step_callback", "ogive_log_callback"}
# Arrays that may be absent: their address is passed, c_null_ptr for none.
NULLABLE = {("ogive_solid_particles", "xyz"), ("ogive_solid_particles", "volume"), ("ogive_mesh_voxelise", "xyz"),
            ("ogive_mesh_voxelise", "volume")}
# Pointers to one number, by name; other pointers to numbers are arrays.
SCALARS = {"dt", "needed", "components", "count", "size"}


def wrapped(start, names, end):
    """A statement's list of names in lines of at most 120 characters."""
    lines, line = [], start
    for i, name in enumerate(names):
        piece = name + (", " if i + 1 < len(names) else "")
        if len(line) + len(piece) > 116:
            lines.append(line + "&")
            line = " " * 8 + piece
        else:
            line += piece
    lines.append(line + end)
    return lines


class Module:
    def __init__(self, name, header, uses, structs_of_others):
        self.name, self.header, self.uses = name, header, uses
        self.structs = set(header.structs) | set(structs_of_others)

    def number(self, type_):
        if type_ in NUMBERS:
            return NUMBERS[type_]
        if type_ in self.structs:
            return f"type({type_})"
        raise SystemExit(f"no Fortran type for {type_}")

    def field(self, field):
        if field.type == "function pointer":
            type_ = "type(c_funptr)"
        elif field.type.endswith("*"):
            type_ = "type(c_ptr)"
        else:
            type_ = self.number(field.type)
        return f"{type_} :: {field.name}" + (f"({field.count})" if field.count else "")

    def argument(self, function, argument):
        type_, name = argument.type, argument.name
        if type_ in CALLBACKS:
            return f"type(c_funptr), value :: {name}"
        if type_ == "const char* const*":
            return f"type(c_ptr), intent(in) :: {name}(*)"
        if not type_.endswith("*"):
            return f"{self.number(type_)}, value :: {name}"
        constant, base = type_.startswith("const "), type_.removeprefix("const ")[:-1]
        if base.endswith("*"):
            return f"type(c_ptr), intent(out) :: {name}"
        if base in OPAQUE or base == "void" or (function, name) in NULLABLE:
            return f"type(c_ptr), value :: {name}"
        if base == "char":
            return f"character(kind=c_char), intent({'in' if constant else 'inout'}) :: {name}(*)"
        intent = "in" if constant else "inout"
        if base in NUMBERS and not (name in SCALARS and not constant):
            return f"{NUMBERS[base]}, intent({intent}) :: {name}(*)"
        return f"{self.number(base)}, intent({intent}) :: {name}"

    def function(self, function):
        arguments = [a.name for a in function.arguments]
        if function.result == "void":
            kind, result = "subroutine", None
        else:
            kind = "function"
            result = "type(c_ptr)" if function.result == "const char*" else self.number(function.result)
        lines = wrapped(f"    {kind} {function.name}(", arguments, f") bind(C)")
        lines += ["      import", "      implicit none"]
        lines += [f"      {self.argument(function.name, a)}" for a in function.arguments]
        if result:
            lines.append(f"      {result} :: {function.name}")
        lines.append(f"    end {kind}")
        return lines

    def text(self, source):
        lines = [f"! The interfaces of {source} in Fortran, name by name. Made by tools/fortran_bindings.py: do not edit.",
                 f"! What the types, fields and functions mean stands in {source}. Strings end with c_null_char; a type(c_ptr)",
                 "! argument is a handle, or the address of an array that may be absent (c_null_ptr).",
                 f"module {self.name}", "  use, intrinsic :: iso_c_binding"]
        lines += [f"  use {module}" for module in self.uses]
        lines += ["  implicit none", "  public", ""]
        for name, value in self.header.constants:
            lines.append(f"  integer(c_int32_t), parameter :: {name} = {value}")
        for name, fields in self.header.structs.items():
            lines += ["", f"  type, bind(C) :: {name}"]
            lines += [f"    {self.field(field)}" for field in fields]
            lines.append(f"  end type {name}")
        lines += ["", "  interface"]
        for function in self.header.functions:
            lines += self.function(function)
        lines += ["  end interface", f"end module {self.name}", ""]
        return "\n".join(lines)


def main():
    core = Header(os.path.join(ROOT, "capi/ogive.h"))
    geometry = Header(os.path.join(ROOT, "geometry/ogive_geometry.h"))
    files = {
        "capi/fortran/ogive_c.f90": Module("ogive_c", core, [], []).text("ogive.h"),
        "capi/fortran/ogive_geometry_c.f90":
            Module("ogive_geometry_c", geometry, ["ogive_c"], core.structs).text("ogive_geometry.h"),
    }
    stale = False
    for name, text in files.items():
        path = os.path.join(ROOT, name)
        present = open(path, encoding="utf-8").read() if os.path.exists(path) else ""
        if "--check" in sys.argv[1:]:
            if present != text:
                print(f"{name} is not what the headers say: run tools/fortran_bindings.py", file=sys.stderr)
                stale = True
        elif present != text:
            with open(path, "w", encoding="utf-8") as stream:
                stream.write(text)
            print(f"{name} written")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
