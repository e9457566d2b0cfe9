#!/usr/bin/python3
"""Draws a section through the bodies of a run, coloured by a field, as PNG.

  plot_section.py RUN                          four instants of a run's particle files side by side
  plot_section.py RUN --times 0.05 0.1         the files nearest to these times
  plot_section.py particles-00003.h5           one file
  plot_section.py RUN --separate -o out.png    one picture for each instant: out-00001.png, ...

RUN is a run's directory or its particles.xdmf. Particles nearer than --mesh-width (default: the scene's cell size, else
twice the particle spacing) to the plane are drawn at their true size, the nearest on top. A body that does not have the
field is grey. Nothing is mirrored unless --mirror asks for it.
"""

import argparse
import glob
import os
import xml.etree.ElementTree

import h5py
import numpy as np
from matplotlib.collections import EllipseCollection
from matplotlib.colors import LinearSegmentedColormap

from plot_common import Refused, Units, label, plt, run_main, scene_of, summary_of

AXES = "xyz"
FIELD_LABELS = {"plastic_strain": ("plastic strain", None), "von_mises": ("von Mises stress", "stress"),
                "pressure": ("pressure", "stress"), "temperature": ("temperature", "K"), "speed": ("speed", "speed"),
                "failed": ("failed", None)}
DRAWN_SIZE = 1.45  # of a particle's edge: discs of this diameter close the gaps of a lattice that is not cubic


# From bare metal over red heat to black.
STRAIN_COLOURS = LinearSegmentedColormap.from_list("strain", ["#d3d9df", "#f3d274", "#ea7a2c", "#a81820", "#3a0710"])


def particle_edges(volume, position, grid):
    """Edges of cubes of the particles' volumes; in a two-dimensional scene of squares of their sections."""
    if grid.get("space") == "axisymmetric":
        return np.sqrt(volume / (2 * np.pi * position[:, 0]))
    if grid.get("space") == "plane_strain":
        return np.sqrt(volume / float(grid.get("thickness", 1.0)))
    return np.cbrt(volume)


class Body:
    """One body's particles near the plane."""

    def __init__(self, group, field, axis, offset, thickness, grid):
        self.name = group.attrs.get("name", group.name.strip("/"))
        if isinstance(self.name, bytes):
            self.name = self.name.decode()
        position = group["position"][()]
        velocity = group["velocity"][()] if "velocity" in group else np.zeros_like(position)
        mass = group["mass"][()] if "mass" in group else np.ones(len(position))
        self.speed = np.linalg.norm(mass @ velocity) / mass.sum() if len(mass) else 0.0
        self.momentum = mass @ velocity if len(mass) else np.zeros(3)
        volume = group["volume"][()] if "volume" in group else np.full(len(position), np.nan)
        spacing = particle_edges(volume, position, grid)
        self.spacing = float(np.nanmedian(spacing)) if np.isfinite(spacing).any() else 1.0
        distance = np.abs(position[:, axis] - offset)
        near = distance <= (thickness or 2 * self.spacing)
        near = np.flatnonzero(near)[np.argsort(-distance[near], kind="stable")]
        self.position = position[near]
        self.size = np.where(np.isfinite(spacing[near]), spacing[near], self.spacing)
        self.value = self.read_field(group, field, velocity, near)
        self.failed = group["failed"][()][near] > 0 if "failed" in group else np.zeros(len(near), bool)

    @staticmethod
    def read_field(group, field, velocity, chosen):
        if field == "speed":
            return np.linalg.norm(velocity[chosen], axis=1)
        name, _, component = field.partition(".")
        if name not in group:
            return None
        values = group[name][()][chosen]
        if values.ndim == 1:
            return values
        names = {3: ["x", "y", "z"], 6: ["xx", "yy", "zz", "xy", "yz", "xz"]}.get(values.shape[1], [])
        if component not in names:
            raise Refused(f"field '{name}' has several components: choose one of "
                          + ", ".join(f"{name}.{n}" for n in names))
        return values[:, names.index(component)]


def particle_files(inputs):
    """The particle files behind the arguments, in order of time."""
    files = []
    for name in inputs:
        if os.path.isdir(name):
            series = os.path.join(name, "particles.xdmf")
            name = series if os.path.exists(series) else os.path.join(name, "particles-*.h5")
        if name.endswith((".xdmf", ".xmf")):
            for item in xml.etree.ElementTree.parse(name).iter("DataItem"):
                file = os.path.join(os.path.dirname(name), (item.text or "").rsplit(":/", 1)[0])
                if file not in files:
                    files.append(file)
        else:
            files += sorted(glob.glob(name)) or [name]
    if not files:
        raise Refused("no particle files there")
    return files


def open_particles(name):
    if not os.path.exists(name):
        raise Refused(f"{name}: no such file")
    try:
        file = h5py.File(name, "r")
    except OSError as problem:
        raise Refused(f"{name}: {problem}") from None
    kind = file.attrs.get("format", b"")
    if (kind.decode() if isinstance(kind, bytes) else kind) != "ogive-particles":
        raise Refused(f"{name}: not a particle file of Ogive")
    return file


def time_of(name):
    with open_particles(name) as file:
        return float(file.attrs["time"])


def read_bodies(name, field, axis, offset, thickness, grid):
    with open_particles(name) as file:
        return [Body(group, field, axis, offset, thickness, grid) for group in file.values()
                if isinstance(group, h5py.Group) and "position" in group and len(group["position"])]


def choose(files, arguments):
    """Those of the files that are to be drawn, with their times."""
    timed = sorted(((time_of(name), name) for name in files), key=lambda pair: pair[0])
    if arguments.times:
        return [min(timed, key=lambda pair: abs(pair[0] - wanted)) for wanted in arguments.times]
    if arguments.count and len(timed) > arguments.count:
        picked = np.unique(np.linspace(0, len(timed) - 1, arguments.count).round().astype(int))
        return [timed[i] for i in picked]
    return timed


def common_limits(instants, across, up, mirror):
    """One frame for all instants; fragments that fly far ahead do not shrink the rest."""
    bodies = [body for instant in instants for body in instant if len(body.position)]
    points = np.concatenate([body.position[~body.failed] for body in bodies])
    if not len(points):
        points = np.concatenate([body.position for body in bodies])
    margin = 2 * max(body.spacing for body in bodies)
    limits = []
    for direction in (across, up):
        low, high = np.percentile(points[:, direction], [0.02, 99.98])
        if mirror == direction:
            high = max(abs(low), abs(high))
            low = -high
        limits.append((low - margin, high + margin))
    return limits


def draw(axes, bodies, across, up, mirror, colours, norm):
    for body in bodies:
        for sign in ((1, -1) if mirror is not None else (1,)):
            points = body.position[:, [across, up]].copy()
            if sign < 0:
                points[:, (across, up).index(mirror)] *= -1
            size = DRAWN_SIZE * body.size
            discs = EllipseCollection(size, size, np.zeros_like(size), units="xy", offsets=points,
                                      offset_transform=axes.transData, linewidth=0, rasterized=True)
            if body.value is None:
                discs.set_facecolor("#5c6670")
            else:
                discs.set(array=body.value, cmap=colours, norm=norm)
            axes.add_collection(discs)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("inputs", nargs="+", metavar="RUN|FILE", help="run directory, .xdmf or particle files")
    parser.add_argument("-o", "--output", default="section.png", help="picture to write (default section.png)")
    parser.add_argument("--field", default="plastic_strain",
                        help="plastic_strain (default), von_mises, pressure, temperature, speed, stress.xx, ...")
    parser.add_argument("--plane", help="section plane, for example x=1.5 (default y=0, of two-dimensional scenes z=0)")
    parser.add_argument("--mesh-width", type=float, help="half thickness of the section (default: the scene's cell)")
    parser.add_argument("--times", type=float, nargs="+", help="instants, in the run's unit of time")
    parser.add_argument("--count", type=int, default=4, help="instants spread over the run (default 4; 0: all)")
    parser.add_argument("--separate", action="store_true", help="one picture for each instant")
    parser.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"), help="range of the colours")
    parser.add_argument("--limits", type=float, nargs=4, metavar=("LEFT", "RIGHT", "BOTTOM", "TOP"), help="frame")
    parser.add_argument("--horizontal", choices=list(AXES), help="axis to the right (default: that of the flight)")
    parser.add_argument("--mirror", choices=list(AXES), help="mirror at this coordinate's zero")
    parser.add_argument("--title", help="default: the scene's")
    parser.add_argument("--dpi", type=int, default=150)
    arguments = parser.parse_args()

    chosen = choose(particle_files(arguments.inputs), arguments)
    directory = os.path.dirname(chosen[0][1]) or "."
    grid = scene_of(directory).get("grid", {})
    try:
        arguments.plane = arguments.plane or ("z=0" if grid.get("space", "three_dimensional") != "three_dimensional" else "y=0")
        name, offset = arguments.plane.split("=")
        axis, offset = AXES.index(name.strip()), float(offset)
    except ValueError:
        raise Refused(f"--plane {arguments.plane}: expected for example y=0") from None

    units = Units(directory)
    cell = grid.get("cell_size")
    thickness = arguments.mesh_width or (cell if isinstance(cell, (int, float)) else None)  # an expression is not worked out
    instants = [read_bodies(name, arguments.field, axis, offset, thickness, grid) for _, name in chosen]
    if not any(len(body.position) for bodies in instants for body in bodies):
        raise Refused(f"no particle is near {arguments.plane}")
    with_field = [body.value for bodies in instants for body in bodies if body.value is not None and len(body.value)]
    if not with_field:
        raise Refused(f"no body has the field '{arguments.field}'")

    # The flight goes from left to right unless told otherwise.
    flight = sum(body.momentum for body in instants[0])
    directions = [a for a in range(3) if a != axis]
    across = AXES.index(arguments.horizontal) if arguments.horizontal else max(directions, key=lambda a: abs(flight[a]))
    if across == axis:
        raise Refused(f"--horizontal {AXES[across]} is normal to the plane")
    up = next(a for a in directions if a != across)
    mirror = AXES.index(arguments.mirror) if arguments.mirror else None
    if mirror == axis:
        raise Refused(f"--mirror {AXES[mirror]} is normal to the plane")

    values = np.concatenate(with_field)
    low, high = arguments.range or (min(0.0, float(values.min())), float(np.percentile(values, 99.8)))
    norm = plt.Normalize(low, high if high > low else low + 1)
    colours = STRAIN_COLOURS if arguments.field == "plastic_strain" else plt.get_cmap("turbo")
    limits = arguments.limits and [arguments.limits[:2], arguments.limits[2:]] or common_limits(instants, across, up,
                                                                                                 mirror)
    ratio = (limits[1][1] - limits[1][0]) / (limits[0][1] - limits[0][0])
    title = arguments.title or summary_of(directory).get("title", "")
    fastest = max(instants[0], key=lambda body: body.speed).name
    time_unit, time_factor = units.time_scale(max(time for time, _ in chosen))
    text, unit = FIELD_LABELS.get(arguments.field, (arguments.field, "stress" if "stress" in arguments.field else None))
    unit = getattr(units, unit, unit) if unit else ""

    groups = [[i] for i in range(len(chosen))] if arguments.separate else [list(range(len(chosen)))]
    stem, suffix = os.path.splitext(arguments.output)
    for number, group in enumerate(groups):
        columns = min(len(group), 4)
        rows = -(-len(group) // columns)
        width = max(2.6, min(4.5, 12 / columns)) if len(group) > 1 else 6
        figure, panels = plt.subplots(rows, columns, squeeze=False, sharex=True, sharey=True, layout="constrained",
                                      figsize=(width * columns + 0.8, min(12, width * ratio * rows) + 0.9))
        for panel in panels.flat[len(group):]:
            panel.set_visible(False)
        for panel, i in zip(panels.flat, group):
            draw(panel, instants[i], across, up, mirror, colours, norm)
            panel.set(xlim=limits[0], ylim=limits[1], aspect="equal")
            speed = [body.speed for body in instants[i] if body.name == fastest]
            panel.set_title(f"t = {chosen[i][0] * time_factor:.3g} {time_unit}"
                            + (f", {fastest} {speed[0]:.0f} {units.speed}" if speed else ""))
            panel.set_xlabel(label(AXES[across], units.length))
        for panel in panels[:, 0]:
            panel.set_ylabel(label(AXES[up], units.length))
        bar = figure.colorbar(plt.cm.ScalarMappable(norm, colours), ax=panels, fraction=0.03, pad=0.01,
                              extend="max" if values.max() > high else "neither")
        bar.set_label(label(text, unit))
        if title:
            figure.suptitle(title)
        output = f"{stem}-{number:05d}{suffix}" if arguments.separate else arguments.output
        figure.savefig(output, dpi=arguments.dpi)
        plt.close(figure)
        print(output)


if __name__ == "__main__":
    run_main(main)
