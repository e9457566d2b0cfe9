#!/usr/bin/python3
"""Full model against planned model of every example scene: cost and difference in the result.

  plan_table.py [--program build/release/bin/ogive] [--work DIR] [--only SCENE] [--table-only]

The example scenes are written as the halves and quarters that a user would make by hand. Here their symmetry faces are taken
away first (the full model); the planned model is the full one with symmetry = "auto", and where the scene is one of
revolution another with symmetry = "axisymmetric". Everything on one thread; cost is the processor time of stepping. Writes
docs/data/plan.csv and the table between the markers of docs/performance.md. Runs in DIR that are finished are not run again.
"""

import os
import tempfile

from plot_common import run_main
from validation_table import (NO_FILES, markdown_table, read_table, replace_block, run_scene,
                              table_arguments, value_of, write_table)

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
DATA = os.path.join(ROOT, "docs", "data", "plan.csv")
PAGE = os.path.join(ROOT, "docs", "performance.md")
HELD_BEAM = ("clamps=[" + ",".join('{body="beam",region="box",lower=[%s,0,0],upper=[%s,1000,"depth"]}' % ends
                                   for ends in (('"1000-cell"', "1000"), ("-1000", '"cell-1000"'))) + "]")
# Scene, and after @ which variant of it: (label, what makes it whole, result and where it stands in summary.json, unit, of
# revolution). After the flight axis of a scene of revolution has become y, results along z are found there.
SCENES = {
    "thick_plate": ("thick plate, 575 m/s", ["grid.faces.y_min=free", "grid.lower.1=-60"], "residual velocity",
                    ["results", "residual_velocity"], "m/s", False),
    "steel_ball": ("steel ball", ["grid.faces.x_min=free", "grid.faces.y_min=free", 'grid.lower.0="-cell*(rint(plate_radius/cell)+3)"',
                                  'grid.lower.1="-cell*(rint(plate_radius/cell)+3)"'],
                   "residual velocity", ["results", "residual_velocity"], "m/s", True),
    "taylor_copper": ("copper bar", ["grid.faces.x_min=free", "grid.faces.y_min=free", "grid.lower.0=-12", "grid.lower.1=-12"],
                      "final length", ["bodies", "bar", "upper", 2], "mm", True),
    "rings": ("rings", ["grid.faces.y_min=free", "grid.faces.z_min=free", "grid.lower.1=-80", "grid.lower.2=-14"],
              "speed of the second", ["bodies", "right", "velocity", 0], "m/s", False),
    "two_spheres": ("two spheres", ["grid.faces.y_min=free", "grid.faces.z_min=free", "grid.lower.1=-6", "grid.lower.2=-6"],
                    "speed of the second", ["bodies", "second", "velocity", 0], "", False),
    "two_spheres@fine": ("two spheres, half the cells", ["grid.faces.y_min=free", "grid.faces.z_min=free", "grid.lower.1=-6",
                                                         "grid.lower.2=-6", "parameters.cell=0.5"],
                         "speed of the second", ["bodies", "second", "velocity", 0], "", False),
    "rolling_sphere": ("rolling sphere", ["grid.faces.y_min=free", "grid.lower.1=-2.4"], "way", ["bodies", "sphere", "centre", 0], "m", False),
    "rolling_cylinder": ("rolling cylinder", ["grid.faces.y_min=free", "grid.lower.1=-2"], "way", ["bodies", "cylinder", "centre", 0], "m",
                         False),
    "beam_on_cylinder": ("beam on a cylinder", ["grid.faces.x_min=free", "grid.lower.0=-1500"], "speed of the beam",
                         ["bodies", "beam", "velocity", 1], "m/s", False),
    "cylinder_on_beam": ("cylinder on a beam", ["grid.faces.x_min=free", "grid.lower.0=-1500", HELD_BEAM], "centre of the beam",
                         ["bodies", "beam", "centre", 1], "mm", False),
    "thick_target": ("thick target", ["grid.faces.x_min=free", "grid.faces.y_min=free", 'grid.lower.0="-cell*(rint(half_width/cell)+4)"',
                                      'grid.lower.1="-cell*(rint(half_width/cell)+4)"'],
                     "speed of the ball", ["bodies", "ball", "velocity", 2], "m/s", False),
    "four_spheres": ("four spheres", [], "speed of the striker", ["bodies", "striker", "velocity", 2], "m/s", False),
}


def rows_of(program, work, scene):
    _, whole, result, path, _, of_revolution = SCENES[scene]
    rows = []
    models = {"full": ["symmetry=none"], "planned": ["symmetry=auto"]}
    if of_revolution:
        models["axisymmetric"] = ["symmetry=axisymmetric"]
    for model, settings in models.items():
        summary = run_scene(program, f"{scene.split('@')[0]}/scene.toml", os.path.join(work, f"{scene}-{model}"),
                            NO_FILES + whole + settings)
        value = value_of(summary, path[:-1] + [1] if model == "axisymmetric" and path[-1] == 2 else path)
        rows.append({"scene": scene, "model": model, "particles": summary["particles"], "steps": summary["steps"],
                     "seconds": f"{summary['cpu_seconds']['stepping']:.4g}", "megabytes": f"{summary['peak_memory_bytes'] / 1e6:.4g}",
                     "result": result, "value": f"{value:.10g}"})
    return rows


def table(rows):
    lines = []
    for scene, (label, _, result, _, unit, _) in SCENES.items():
        of = {row["model"]: row for row in rows if row["scene"] == scene}
        for model in ("planned", "axisymmetric"):
            if model not in of:
                continue
            full, row = of["full"], of[model]
            share = int(full["particles"]) / int(row["particles"])
            what = "axisymmetric" if model == "axisymmetric" else {1: "whole", 2: "half", 4: "quarter", 8: "eighth"}[round(share)]
            slow, fast = float(full["seconds"]), float(row["seconds"])
            difference = float(row["value"]) / float(full["value"]) - 1
            lines.append([label, what, f"{int(full['particles']):,} / {int(row['particles']):,}", f"{slow:.3g} / {fast:.3g}",
                          f"**{slow / fast:.3g}**", f"{float(full['megabytes']):.3g} / {float(row['megabytes']):.3g}", result,
                          f"{float(full['value']):.5g} {unit}", f"{float(row['value']):.5g} {unit}",
                          f"{100 * difference:+.2f} %" if abs(difference) > 1e-6 else f"{difference:+.1e}"])
    return markdown_table(["scene", "planned model", "particles", "processor time [s]", "faster", "memory [MB]", "result",
                           "full", "planned", "difference"], lines)


def main():
    parser = table_arguments(__doc__, os.path.join(ROOT, "build", "release", "bin", "ogive"))
    parser.add_argument("--only", choices=list(SCENES))
    arguments = parser.parse_args()
    rows = read_table(DATA)
    if not arguments.table_only:
        with tempfile.TemporaryDirectory() as temporary:
            work = arguments.work or temporary
            os.makedirs(work, exist_ok=True)
            for scene in [arguments.only] if arguments.only else list(SCENES):
                rows = [row for row in rows if row["scene"] != scene] + rows_of(arguments.program, work, scene)
        write_table(DATA, rows)
    replace_block(PAGE, "plan", table(rows))
    print(table(rows))


if __name__ == "__main__":
    run_main(main)
