#!/usr/bin/python3
"""Shape of the plate and speed of the ball after a run of examples/scenes/steel_ball, beside Huang et al. 2010, Table II.

  measure_steel_ball.py RUN [RUN ...]          from the last particle file of each run
  measure_steel_ball.py RUN --at 0.24          from the file nearest to that time

The deformed plate is what is left of it: the largest set of particles that have not failed and hang together, which they
do if they lie in the same cell of the grid or in neighbouring ones (by face, edge or corner). Failed particles and debris
do not count. Particles have the size of the initial lattice:
  h   highest minus lowest point of that plate along the flight
  D   diameter of the hole: twice the smallest distance from the axis of flight to that plate
The ball is through when its centre is beyond the highest point of that plate and it flies on.
"""

import argparse
import csv
import os

import numpy as np

from plot_common import Refused, run_main, scene_of, summary_of
from plot_section import open_particles, particle_files, time_of

EXPERIMENT = 0.84  # h/D
REFERENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "data", "huang2010_steel_ball.csv")


def read_table_ii():
    """{model: row of Table II}, numbers as numbers."""
    with open(REFERENCE, encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {row["model"]: {key: float(value) for key, value in row.items() if key != "model"} for row in rows}


def largest_connected(position, cell):
    """Mask of the particles in the largest set of occupied cells that touch each other."""
    index = np.floor(position / cell).astype(np.int64)
    index -= index.min(axis=0) - 1
    extent = index.max(axis=0) + 2
    strides = np.array([extent[1] * extent[2], extent[2], 1])
    occupied, cell_of, particles_in = np.unique(index @ strides, return_inverse=True, return_counts=True)
    label = np.arange(len(occupied))
    offsets = [np.dot((i, j, k), strides) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
    links = []
    for offset in (o for o in offsets if o > 0):
        at = np.searchsorted(occupied, occupied + offset).clip(max=len(occupied) - 1)
        here = np.flatnonzero(occupied[at] == occupied + offset)
        links.append(np.stack([here, at[here]]))
    first, second = np.concatenate(links, axis=1)
    while True:  # the smallest label spreads over the links; pointer jumping makes it fast
        before = label.copy()
        lower = np.minimum(label[first], label[second])
        np.minimum.at(label, label[first], lower)
        np.minimum.at(label, label[second], lower)
        label = label[label]
        if np.array_equal(before, label):
            break
    largest = np.bincount(label, weights=particles_in).argmax()
    return (label == largest)[cell_of]


def measure(name, parameters, axisymmetric=False):
    """The numbers of one particle file. The flight is along z from the axis on, of axisymmetric.toml along y."""
    flight = 1 if axisymmetric else 2
    with open_particles(name) as file:
        time = float(file.attrs["time"])
        ball, plate = file["ball"], file["plate"]
        failed = plate["failed"][()] > 0
        position = plate["position"][()][~failed]
        kept = largest_connected(position, parameters["cell"])
        position = position[kept]
        mass = ball["mass"][()]
        ball_velocity = mass @ ball["velocity"][()] / mass.sum()
        ball_centre = mass @ ball["position"][()] / mass.sum()
    highest = position[:, flight].max() + 0.5 * parameters["layer"]
    lowest = position[:, flight].min() - 0.5 * parameters["layer"]
    radius = position[:, 0] if axisymmetric else np.hypot(position[:, 0], position[:, 1])
    smallest = radius.min() - 0.5 * parameters["spacing"]
    return {"time": time, "ball_velocity": ball_velocity[flight], "h": highest - lowest, "D": 2 * max(smallest, 0.0),
            "through": bool(ball_centre[flight] > highest and ball_velocity[flight] > 0), "failed": int(failed.sum()), "debris": int((~kept).sum())}


def measure_run(directory, at=None):
    """The numbers of a run: (measured, parameters)."""
    parameters = summary_of(directory).get("parameters", {})
    missing = [name for name in ("cell", "spacing", "layer") if name not in parameters]
    if missing:
        raise Refused(f"{directory}: no summary.json of a finished run of the steel_ball scene (no parameter "
                      f"{', '.join(missing)})")
    files = particle_files([directory])
    chosen = files[-1] if at is None else min(files, key=lambda name: abs(time_of(name) - at))
    axisymmetric = scene_of(directory).get("grid", {}).get("space") == "axisymmetric"
    return measure(chosen, parameters, axisymmetric), parameters


def model_of(parameters):
    """Name and row of Table II of the run's model; "-" and nothing if it is not one of the paper's."""
    for name, row in read_table_ii().items():
        if abs(row["cell_size"] - parameters["cell"]) < 1e-9 and abs(row["spacing"] - parameters["spacing"]) < 1e-9:
            return name, row
    return "-", {}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="RUN", help="directory of a run")
    parser.add_argument("--at", type=float, help="time of the particle file, ms (default: the last)")
    arguments = parser.parse_args()
    for run in arguments.runs:
        measured, parameters = measure_run(run, arguments.at)
        name, row = model_of(parameters)
        ratio = f"{measured['h'] / measured['D']:.3f}" if measured["D"] > 0 else "-"
        print(f"{os.path.normpath(run)}: model {name}, t = {1000 * measured['time']:.0f} us, "
              f"ball {measured['ball_velocity']:.1f} m/s, {'through' if measured['through'] else 'not through'}")
        print(f"  h = {measured['h']:.3f} mm, D = {measured['D']:.3f} mm, h/D = {ratio}; "
              f"{measured['failed']} failed particles, {measured['debris']} others torn off")
        for method in ("huang_first", "huang_second") if row else ():
            print(f"  paper, {method}: Vr {row[method + '_velocity']:g} m/s, h/D {row[method + '_h_over_d']:g}")
        print(f"  experiment: h/D {EXPERIMENT}")


if __name__ == "__main__":
    run_main(main)
