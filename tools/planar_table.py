#!/usr/bin/python3
"""Axisymmetric models beside quarter models of the same cell size: cost and difference in the result.

  planar_table.py [--program build/bench/bin/ogive] [--work DIR] [--only NAME] [--table-only]
  planar_table.py --check --program OGIVE

Runs examples/scenes/taylor_copper and steel_ball as they are (quarter models) and their axisymmetric.toml on one thread, writes
docs/data/planar.csv and the table between the markers of docs/performance.md. Cost is the processor time of stepping, as
summary.json has it; short runs are repeated and the best is kept. The discretisation error of a result is its distance from
that of an axisymmetric model with much smaller cells. --only runs one of the scenes and keeps the
other's rows; --table-only writes the table from the data. --check runs the axisymmetric models at the scenes' cells and
fails where a result is not that of the data, or is farther from the quarter model's than the discretisation error.
"""

import os
import tempfile

from measure_steel_ball import measure_run
from plot_common import Refused, run_main, summary_of
from validation_table import markdown_table, read_table, replace_block, run_scene, table_arguments, write_table

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
DATA = os.path.join(ROOT, "docs", "data", "planar.csv")
PAGE = os.path.join(ROOT, "docs", "performance.md")
# Cells that are compared; the first are those of the scenes.
CELLS = {"taylor_copper": [0.4, 0.25, 0.2], "steel_ball": [0.66]}
# The rim of the hole tears into teeth, whose height a body of revolution cannot have: not asked for by --check.
NOT_REVOLVED = {"height of the plate"}
FINE = {"taylor_copper": 0.1, "steel_ball": 0.165}  # cells for the discretisation error
LABELS = {"taylor_copper": "copper bar", "steel_ball": "steel ball"}
UNITS = {"final length": "mm", "radius of the foot": "mm", "residual velocity": "m/s", "height of the plate": "mm",
         "diameter of the hole": "mm"}
SHORT = 20  # seconds: what takes less is repeated


def results_of(scene, run, model):
    """{name: value} of a finished run."""
    bodies = summary_of(run)["bodies"]
    if scene == "taylor_copper":
        along = 1 if model == "axisymmetric" else 2
        return {"final length": bodies["bar"]["upper"][along], "radius of the foot": bodies["bar"]["upper"][0]}
    measured, _ = measure_run(run)
    return {"residual velocity": summary_of(run)["results"]["residual_velocity"], "height of the plate": measured["h"],
            "diameter of the hole": measured["D"]}


class Runner:
    def __init__(self, program, work):
        self.program, self.work = program, work

    def run(self, scene, model, cell, repeats):
        """(summary, results) of the quickest of the runs."""
        file = os.path.join(scene, "axisymmetric.toml" if model == "axisymmetric" else "scene.toml")
        settings = [f"parameters.cell={cell}", f"parameters.spacing={cell / 2}",
                    "output.particle_interval=0.08"]
        best = None
        for attempt in range(repeats):
            directory = tempfile.mkdtemp(dir=self.work, prefix=f"{scene}-{model}-{cell:g}-")
            summary = run_scene(self.program, file, os.path.join(directory, "run"), settings)
            if best is None or summary["cpu_seconds"]["stepping"] < best[0]["cpu_seconds"]["stepping"]:
                best = summary, results_of(scene, os.path.join(directory, "run"), model)
            if summary["cpu_seconds"]["stepping"] > SHORT:
                break
        return best

    def rows_of(self, scene):
        rows = []
        _, finest = self.run(scene, "axisymmetric", FINE[scene], 1)
        for cell in CELLS[scene]:
            for model in ("quarter", "axisymmetric"):
                summary, results = self.run(scene, model, cell, 5)
                for name, value in results.items():
                    rows.append({"scene": scene, "cell": f"{cell:g}", "model": model, "particles": summary["particles"],
                                 "steps": summary["steps"], "seconds": f"{summary['cpu_seconds']['stepping']:.4g}",
                                 "megabytes": f"{summary['peak_memory_bytes'] / 1e6:.4g}", "result": name,
                                 "value": f"{value:.6g}", "finer": f"{finest[name]:.6g}"})
        return rows


def table(rows):
    lines = []
    quarters = {(row["scene"], row["cell"], row["result"]): row for row in rows if row["model"] == "quarter"}
    before = None
    for row in rows:
        if row["model"] != "axisymmetric":
            continue
        quarter = quarters[row["scene"], row["cell"], row["result"]]
        value, other, finest = float(row["value"]), float(quarter["value"]), float(row["finer"])
        case = (row["scene"], row["cell"])
        cost = ["", "", "", "", ""]
        if case != before:
            slow, fast = float(quarter["seconds"]), float(row["seconds"])
            cost = [f"{LABELS[row['scene']]}, {row['cell']} mm", f"{int(quarter['particles']):,} / {int(row['particles']):,}",
                    f"{slow:.3g} s / {fast:.3g} s", f"**{slow / fast:.3g}**",
                    f"{float(quarter['megabytes']):.3g} / {float(row['megabytes']):.3g} MB"]
        before = case
        lines.append(cost + [f"{row['result']} [{UNITS[row['result']]}]", f"{other:.4g}", f"{value:.4g}",
                             f"{100 * (value / other - 1):+.2f} %", f"{100 * (value / finest - 1):+.2f} %"])
    return markdown_table(["scene, cell", "particles", "processor time", "faster", "memory", "result", "quarter",
                           "axisymmetric", "difference", "discretisation error"], lines)


def check(runner, rows):
    """Raises Refused with all that is not as it should be."""
    wrong = []
    for scene, cells in CELLS.items():
        _, results = runner.run(scene, "axisymmetric", cells[0], 1)
        recorded = {(row["model"], row["result"]): row for row in rows
                    if row["scene"] == scene and row["cell"] == f"{cells[0]:g}"}
        for name, value in results.items():
            quarter, rings = recorded["quarter", name], recorded["axisymmetric", name]
            # Processors add in other orders; where material tears that grows.
            if abs(value / float(rings["value"]) - 1) > 0.01:
                wrong.append(f"{scene}: {name} is {value:g}, {rings['value']} in docs/data/planar.csv")
            apart, error = abs(value - float(quarter["value"])), abs(value - float(rings["finer"]))
            if apart > error and name not in NOT_REVOLVED:
                wrong.append(f"{scene}: {name} is {apart:g} from the quarter model, the discretisation error is {error:g}")
    if wrong:
        raise Refused("\n".join(wrong))


def main():
    parser = table_arguments(__doc__, os.path.join(ROOT, "build", "bench", "bin", "ogive"))
    parser.add_argument("--only", choices=sorted(CELLS), help="run this scene only")
    parser.add_argument("--check", action="store_true", help="nothing is written: are the results as in the data?")
    arguments = parser.parse_args()
    rows = read_table(DATA)
    if arguments.check:
        with tempfile.TemporaryDirectory() as temporary:
            check(Runner(arguments.program, arguments.work or temporary), rows)
        return
    if not arguments.table_only:
        with tempfile.TemporaryDirectory() as temporary:
            work = arguments.work or temporary
            os.makedirs(work, exist_ok=True)
            runner = Runner(arguments.program, work)
            for scene in [arguments.only] if arguments.only else list(CELLS):
                rows = [row for row in rows if row["scene"] != scene] + runner.rows_of(scene)
        order = list(CELLS)
        rows.sort(key=lambda row: order.index(row["scene"]))
        write_table(DATA, rows)
    replace_block(PAGE, "planar", table(rows))
    print(table(rows))


if __name__ == "__main__":
    run_main(main)
