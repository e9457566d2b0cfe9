#!/usr/bin/python3
"""The beam of examples/scenes/beam_on_cylinder by finite elements, with CalculiX: an independent reference.

  beam_reference.py --work DIR [--penalty MPa/mm] [--step FRACTION] [--element C3D8R] [--ccx PROGRAM] [CELLS ...]

CELLS: bricks through the beam's 200 mm, default 4 8 16 (one, three, twenty minutes). --penalty: contact pressure for one mm of
penetration, default 2e4. --step: time step as a fraction of brick / wave speed, default 0.1; with ccx's own, 0.4, and even with 0.2 some
runs gain energy without bound after some ms.
Needs ccx (Debian: calculix-ccx, 2.20). DIR gets decks, logs, and for each mesh beam_CELLS.csv: time, mean velocity, force.

Explicit dynamics with finite strain, one layer of bricks that do not move in z, x = 0 a mirror, J2 plasticity with linear isotropic
hardening, contact of the beam's nodes with a fixed cylinder of flat facets (2 degrees: 0.06 mm), no friction. C3D8R has one point
and hourglass control; C3D8 locks here; with C3D8I in explicit steps force and momentum disagree. Massless contact cannot be used: ccx
takes no constraint on its nodes, and all are held in z.

Velocity: of the centre of mass. Force: on the half beam, for one mm of depth, from that velocity, mean of 0.5 ms. Plastic strain:
the largest at the bricks' points. Kinetic energy: at the end, of that at the start; some percent of it would mean an unstable run.
"""

import argparse
import pathlib
import subprocess
import time

import numpy as np

LENGTH, THICKNESS, RADIUS, GAP, SPEED, END = 1000.0, 200.0, 400.0, 2.0, 50.0, 15.0  # mm, m/s, ms; the length is that of half the beam
YOUNG, POISSON, YIELD, HARDENING, DENSITY = 210e3, 0.28, 200.0, 210.0, 7.85e-3  # MPa, g/mm3
FACET, WINDOW, PRINTED = 2.0, 0.5, 0.025  # degrees, ms, ms
WORDS = ((0, 0), (1, 0), (1, 1), (0, 1))


def rows(numbers):
    return [",".join(map(str, line)) for line in numbers]


def deck(cells, options):
    long, size = round(cells * LENGTH / THICKNESS), THICKNESS / cells
    beam = np.arange(1, 2 * (cells + 1) * (long + 1) + 1).reshape(2, cells + 1, long + 1)
    angles = np.radians(np.arange(-6, 90 + FACET / 2, FACET))  # from the upward direction; past the mirror and past the last contact
    cylinder = beam[-1, -1, -1] + np.arange(1, 4 * len(angles) + 1).reshape(2, 2, len(angles))

    stiffness = YOUNG * (1 - POISSON) / ((1 + POISSON) * (1 - 2 * POISSON))
    step = options.step * size / np.sqrt(stiffness / DENSITY)
    often = f"FREQUENCY={max(1, round(PRINTED / step))}"

    lines = ["*NODE"]
    for k, j, i in np.ndindex(beam.shape):
        lines.append(f"{beam[k, j, i]},{i * size:.9g},{RADIUS + GAP + j * size:.9g},{k * size:.9g}")
    for k, j, i in np.ndindex(cylinder.shape):
        radius, z = RADIUS - (1 - j) * 20, (1.4 * k - 0.2) * size  # somewhat wider than the beam, so that no node leaves the facets
        lines.append(f"{cylinder[k, j, i]},{radius * np.sin(angles[i]):.9g},{radius * np.cos(angles[i]):.9g},{z:.9g}")
    lines += ["*NSET,NSET=BEAM,GENERATE", f"1,{beam[-1, -1, -1]}", "*NSET,NSET=MIRROR", *rows(beam[:, :, :1].reshape(-1, 1))]
    lines += ["*NSET,NSET=CYLINDER,GENERATE", f"{cylinder[0, 0, 0]},{cylinder[-1, -1, -1]}"]

    count = 0
    for name, kind, nodes in (("BEAM", options.element, beam), ("CYLINDER", "C3D8", cylinder)):
        lines.append(f"*ELEMENT,TYPE={kind},ELSET={name}")
        for j, i in np.ndindex(nodes.shape[1] - 1, nodes.shape[2] - 1):
            count += 1
            lines += rows([[count] + [nodes[k, j + b, i + a] for k in (0, 1) for a, b in WORDS]])
    bricks = cells * long
    lines += ["*SURFACE,NAME=LOWER,TYPE=ELEMENT"] + [f"{brick},S3" for brick in range(1, long + 1)]
    lines += ["*SURFACE,NAME=ROUND,TYPE=ELEMENT"] + [f"{brick},S5" for brick in range(bricks + 1, count + 1)]

    # The cylinder does not move; its density only keeps its bricks from setting the time step.
    for name, density in (("BEAM", DENSITY), ("CYLINDER", 1.0)):
        lines += [f"*MATERIAL,NAME={name}", "*ELASTIC", f"{YOUNG},{POISSON}", "*DENSITY", str(density)]
        if name == "BEAM":
            lines += ["*PLASTIC", f"{YIELD},0.", f"{YIELD + 4 * HARDENING},4."]
        lines.append(f"*SOLID SECTION,ELSET={name},MATERIAL={name}")
    lines += ["*SURFACE INTERACTION,NAME=SMOOTH", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{options.penalty},",
              "*CONTACT PAIR,INTERACTION=SMOOTH,TYPE=NODE TO SURFACE", "LOWER,ROUND",
              "*BOUNDARY", "CYLINDER,1,3", "BEAM,3,3", "MIRROR,1,1",
              "*INITIAL CONDITIONS,TYPE=VELOCITY", f"BEAM,2,{-SPEED}",
              "*STEP,NLGEOM,INC=100000000", "*DYNAMIC,EXPLICIT", f"{step / 4:.6g},{END},1e-12,{step:.6g}",
              f"*NODE PRINT,NSET=BEAM,{often}", "V", f"*EL PRINT,ELSET=BEAM,{often}", "PEEQ", "*END STEP", ""]
    return "\n".join(lines)


def number(word):
    return float(word) if "E" in word or "NaN" in word else 0.0  # of 1e-308, Fortran prints no E


def blocks(path):
    """The tables of a .dat file: (first word of the head, time, columns as text)."""
    head, table = None, []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if words and "time" in words:
                if head:
                    yield (*head, table)
                head, table = (words[0], float(words[-1])), []
            elif words:
                table.append(words)
    if head:
        yield (*head, table)


def history(path, cells):
    """Times and mean velocities; times and largest plastic strains; the last kinetic energy, of the first."""
    long = round(cells * LENGTH / THICKNESS)
    share = np.ones((2, cells + 1, long + 1))
    share[:, [0, -1], :] /= 2
    share[:, :, [0, -1]] /= 2
    share = share.ravel() / share.sum()
    velocity, strain, energy = [(0.0, -SPEED)], [(0.0, 0.0)], 1.0
    for head, instant, table in blocks(path):
        if head == "velocities":
            each = np.array([[number(word) for word in line[1:4]] for line in table])
            velocity.append((instant, share @ each[:, 1]))
            energy = share @ (each**2).sum(axis=1) / SPEED**2
        else:
            strain.append((instant, max(number(line[2]) for line in table)))
    return np.array(velocity), np.array(strain), energy


def fall(cells, options):
    name = f"beam_{cells}"
    (options.work / f"{name}.inp").write_text(deck(cells, options), encoding="ascii")
    start = time.monotonic()
    with open(options.work / f"{name}.log", "w", encoding="utf-8") as log:
        subprocess.run([options.ccx, name], cwd=options.work, stdout=log, stderr=subprocess.STDOUT, check=False)
    spent = time.monotonic() - start
    velocity, strain, energy = history(options.work / f"{name}.dat", cells)
    if velocity[-1, 0] < END * (1 - 1e-6) or not np.isfinite(velocity).all():
        raise SystemExit(f"ccx did not reach {END:g} ms: see {name}.log")

    mass = DENSITY * LENGTH * THICKNESS
    instants = np.linspace(0, END, round(END / 0.05) + 1)
    smooth = mass / WINDOW * (np.interp(instants + WINDOW / 2, *velocity.T) - np.interp(instants - WINDOW / 2, *velocity.T))
    at = lambda instant: np.interp(instant, *velocity.T)
    turn = np.argmax(velocity[:, 1] > 0)
    rest = np.interp(0, *velocity[turn - 1:turn + 1, ::-1].T) if turn else np.nan
    parted = velocity[np.nonzero(np.abs(velocity[:, 1] - velocity[-1, 1]) > 1e-3)[0][-1], 0]
    np.savetxt(options.work / f"{name}.csv", np.stack([instants, at(instants), smooth], axis=1), fmt="%.6g", delimiter=",",
               header="time,velocity,force", comments="")
    return [at(2), at(4), at(8), rest, at(12), at(13), at(15), parted, smooth.max(), np.interp(12, *strain.T), 100 * energy, spent]


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("cells", metavar="CELLS", nargs="*", type=int, default=[4, 8, 16])
parser.add_argument("--work", metavar="DIR", type=pathlib.Path, required=True)
parser.add_argument("--penalty", type=float, default=2e4)
parser.add_argument("--step", type=float, default=0.1)
parser.add_argument("--element", default="C3D8R")
parser.add_argument("--ccx", default="ccx")
options = parser.parse_args()
options.work.mkdir(parents=True, exist_ok=True)
print("| bricks | m/s at 2 ms | 4 ms | 8 ms | at rest, ms | m/s at 12 ms | 13 ms | 15 ms | last contact, ms | peak force, N/mm "
      "| plastic strain at 12 ms | kinetic energy % | wall s |")
print("|---|---|---|---|---|---|---|---|---|---|---|---|---|")
for cells in options.cells:
    form = ["%.2f"] * 8 + ["%.0f", "%.3f", "%.2f", "%.0f"]
    print(f"| {cells} | " + " | ".join(f % value for f, value in zip(form, fall(cells, options))) + " |", flush=True)
