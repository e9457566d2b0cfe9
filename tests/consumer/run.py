#!/usr/bin/env python3
"""Installs a build tree and builds outside projects against it: with CMake, with pkg-config and a C compiler, with gfortran;
shared and static. Each runs a simulation; all come to the same bits.

    run.py ROOT BUILD SCRATCH
"""
import os
import re
import sys

from common import fresh, run, speed

root, build, scratch = map(os.path.abspath, sys.argv[1:])
consumer = os.path.join(root, "tests/consumer")
fresh(scratch)
prefix = os.path.join(scratch, "prefix")
run("cmake", "--install", build, "--prefix", prefix)
# Moved afterwards: nothing of it may remember where it was put first.
os.rename(prefix, prefix + "-moved")
prefix += "-moved"

libraries = [d for d, _, names in os.walk(prefix) if "libogive.so" in names][0]
for name in ("libogive.so.0", "libogive.a", "libogive_io.so.0", "libogive_geometry.so.0", "libogive_fortran.a",
             "cmake/ogive/ogiveConfig.cmake", "pkgconfig/ogive.pc"):
    if not os.path.exists(os.path.join(libraries, name)):
        sys.exit(f"{name} is not installed")
for name in ("include/ogive.h", "include/ogive_geometry.h", "share/ogive/fortran/ogive.f90", "share/man/man1/ogive.1",
             "share/ogive/examples/c/thick_plate.c"):
    if not os.path.exists(os.path.join(prefix, name)):
        sys.exit(f"{name} is not installed")
version = run(os.path.join(prefix, "bin/ogive"), "--version")
if "0.2.0" not in version:
    sys.exit(f"the installed program says {version}")
speeds = {}

# CMake.
tree = os.path.join(scratch, "cmake")
run("cmake", "-S", os.path.join(consumer, "cmake"), "-B", tree, f"-DCMAKE_PREFIX_PATH={prefix}")
run("cmake", "--build", tree)
for name in ("host_core", "host_core_static", "host_fortran"):
    speeds["cmake " + name] = speed(run(os.path.join(tree, name)))
for name in ("files", "files_static"):
    print(name, run(os.path.join(tree, name), scratch).strip())

# pkg-config and cc, gfortran.
environment = dict(os.environ, PKG_CONFIG_PATH=os.path.join(libraries, "pkgconfig"))


def flags(*arguments):
    return run("pkg-config", *arguments, env=environment).split()


def built(name, *command):
    program = os.path.join(scratch, name)
    run(*command, "-o", program)
    return program


at_run_time = dict(os.environ, LD_LIBRARY_PATH=libraries)
host = os.path.join(consumer, "host.c")
program = built("pc_host", "cc", "-std=c11", "-Wall", "-Wextra", "-Werror", host, *flags("--cflags", "--libs", "ogive"), "-lm")
speeds["pkg-config"] = speed(run(program, env=at_run_time))
needed = re.findall(r"NEEDED.*\[(.*?)\]", run("readelf", "-d", program))
loaded = run("ldd", program, env=at_run_time)
for library in ("CGAL", "boost", "hdf5", "gmp", "mpfr"):
    if library.lower() in loaded.lower():
        sys.exit(f"a host of the core alone loads {library}:\n{loaded}")
print("a host of the core alone needs", ", ".join(needed))
program = built("pc_static", "cc", "-std=c11", host, *flags("--cflags", "ogive"), os.path.join(libraries, "libogive.a"),
                *[f for f in flags("--static", "--libs-only-l", "ogive") if f != "-logive"], "-lm")
speeds["pkg-config static"] = speed(run(program))
program = built("pc_files", "cc", "-std=c11", os.path.join(consumer, "files.c"),
                *flags("--cflags", "--libs", "ogive_io", "ogive_geometry"))
print(run(program, scratch, env=at_run_time).strip())
program = built("pc_fortran", "gfortran", "-std=f2008", os.path.join(consumer, "host.f90"),
                *flags("--cflags", "--libs", "ogive_fortran"))
speeds["gfortran"] = speed(run(program, env=at_run_time))
# From the module's source, as with another compiler or another version of this one.
sources = [os.path.join(prefix, "share/ogive/fortran", name) for name in ("ogive_c.f90", "ogive.f90")]
fresh(os.path.join(scratch, "modules"))
program = built("pc_fortran_source", "gfortran", "-J", os.path.join(scratch, "modules"), *sources,
                os.path.join(consumer, "host.f90"), *flags("--libs", "ogive"))
speeds["gfortran from source"] = speed(run(program, env=at_run_time))

print(*(f"{name}: {value!r}" for name, value in speeds.items()), sep="\n")
if len(set(speeds.values())) != 1:
    sys.exit("they differ")
