#!/usr/bin/python3
"""The stability atlas: runs the sweeps of studies/atlas, draws the maps and writes the tables of docs/stability.md.

  atlas.py                     all sweeps that are not there yet (half an hour of one core), then maps and tables
  atlas.py --sweeps gap speed  these sweeps alone are run; maps and tables show what is there
  atlas.py --check             the quick part, for the tests: the default settings and the trilinear ones with the stress last in every
                               sweep but the time-step factor; exit code 1 if a verdict is worse than that in docs/data/stability.csv

A case is stable, drifts or fails by the rules of its study: growth or loss of energy, the fastest particle, a breakdown, and what
the sweep measures. Nobody looks at it.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import textwrap

import numpy as np

from plot_common import Refused, plt, run_main
from validation_table import markdown_table, replace_block

TOP = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
STUDIES = os.path.join(TOP, "studies", "atlas")
SWEEPS = ["alpha", "offset", "debris", "speed", "particles", "poisson", "plastic", "shock", "gap", "friction", "density", "stiffness",
          "bodies", "rotation", "stretch", "failed", "symmetry"]
CHECKED = ["B-spline, USF, affine FLIP", "trilinear, MUSL, affine FLIP"]
VERDICTS = ["stable", "drifts", "fails"]
COLOURS = ["#7fc97f", "#fdd16a", "#e0695f"]
TABLE = os.path.join(TOP, "docs", "data", "stability.csv")
DOCUMENT = os.path.join(TOP, "docs", "stability.md")


def run_study(program, name, output, cache, jobs, only=()):
    directory = os.path.join(output, name)
    command = [program, "study", os.path.join(STUDIES, name + ".toml"), "--output", directory, "--cache", cache, "--jobs", str(jobs), "--no-pictures"]
    for wanted in only:
        command += ["--only", wanted]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return directory


def load(directory):
    try:
        with open(os.path.join(directory, "study.json"), encoding="utf-8") as file:
            return json.load(file)
    except FileNotFoundError:
        return None


def point_of(case):
    """What is varied beside the numerics, in one word."""
    return ", ".join(label for axis, label in sorted(case["labels"].items()) if axis != "numerics")


def records(studies):
    """One row for each case: sweep, rows of the map, column, verdict."""
    rows = []
    for name, study in studies.items():
        if name == "alpha":
            continue
        for case in study["cases"]:
            rows.append({"sweep": name, "map": case["sweep"], "numerics": case["labels"]["numerics"], "point": point_of(case),
                         "verdict": case["verdict"], "how": case["how"], "when": case["when"], "energy_growth": case["energy_growth"],
                         "energy_residual": case["energy_residual"]})
    return rows


def bisections(studies):
    if "alpha" not in studies:
        return []
    return [{"map": found["sweep"], "numerics": found["labels"]["numerics"], "largest_stable": found["largest_stable"],
             "smallest_unstable": found["smallest_unstable"], "how": found["how"]} for found in studies["alpha"]["bisections"]]


def draw_map(rows, which, titles, path):
    """Numerics downwards, all sweeps side by side."""
    rows = [row for row in rows if row["map"] == which]
    names = list(dict.fromkeys(row["numerics"] for row in rows))
    sweeps = [name for name in SWEEPS if any(row["sweep"] == name for row in rows)]
    if not sweeps:
        return
    columns = {name: list(dict.fromkeys(row["point"] for row in rows if row["sweep"] == name)) for name in sweeps}
    lines, current = [[]], 0
    for name in sweeps:  # as many sweeps in a line of panels as there is room for
        if current + len(columns[name]) > 30:
            lines.append([])
            current = 0
        lines[-1].append(name)
        current += len(columns[name]) + 1
    figure = plt.figure(figsize=(13, len(lines) * (1.3 + 0.18 * len(names))))
    outer = figure.add_gridspec(len(lines), 1, hspace=0.32 if len(names) > 10 else 0.6)
    for line, members in enumerate(lines):
        spare = max(0, 31 - sum(len(columns[name]) + 1 for name in members))
        ratios = [len(columns[name]) for name in members] + ([spare] if spare else [])
        grid = outer[line].subgridspec(1, len(ratios), width_ratios=ratios, wspace=0.08)
        for i, name in enumerate(members):
            axis = figure.add_subplot(grid[i])
            found = {(row["numerics"], row["point"]): row for row in rows if row["sweep"] == name}
            picture = np.array([[VERDICTS.index(found[n, p]["verdict"]) if (n, p) in found else np.nan for p in columns[name]] for n in names])
            axis.imshow(picture, cmap=plt.matplotlib.colors.ListedColormap(COLOURS), vmin=-0.5, vmax=2.5, aspect="auto")
            for y, n in enumerate(names):
                for x, p in enumerate(columns[name]):
                    row = found.get((n, p))
                    if row is None:
                        axis.text(x, y, "–", ha="center", va="center", fontsize=5.5)
                        continue
                    residual = row["energy_residual"]
                    text = "" if residual is None else f"{100 * residual:+.0f}" if abs(residual) < 10 else "≫"
                    axis.text(x, y, text, ha="center", va="center", fontsize=5.5)
            axis.set_xticks(range(len(columns[name])), columns[name], rotation=60, ha="right", fontsize=6)
            axis.set_yticks(range(len(names)), names if i == 0 else [""] * len(names), fontsize=6.5)
            axis.set_title(textwrap.fill(titles[name], max(9, 4 * len(columns[name]))), fontsize=7)
            axis.tick_params(length=0)
            for side in axis.spines.values():
                side.set_visible(False)
            axis.set_xticks(np.arange(-0.5, len(columns[name])), minor=True)
            axis.set_yticks(np.arange(-0.5, len(names)), minor=True)
            axis.grid(which="minor", color="white", linewidth=1)
            axis.tick_params(which="minor", length=0)
    handles = [plt.matplotlib.patches.Patch(color=colour, label=verdict) for verdict, colour in zip(VERDICTS, COLOURS)]
    figure.legend(handles=handles, loc="lower left", ncols=3, bbox_to_anchor=(0.12, 0.92 if len(lines) > 1 else 0.98), fontsize=8)
    figure.savefig(path, dpi=110)
    plt.close(figure)
    print(path)


def draw_alpha(found, path):
    if not found:
        return
    figure, axis = plt.subplots(figsize=(8, 1 + 0.21 * len(found)))
    names = [row["numerics"] for row in found][::-1]
    values = [row["largest_stable"] or 0 for row in found][::-1]
    tops = [row["smallest_unstable"] or row["largest_stable"] for row in found][::-1]
    axis.barh(range(len(names)), values, color=COLOURS[0])
    axis.barh(range(len(names)), [top - value for top, value in zip(tops, values)], left=values, color=COLOURS[1])
    axis.set_yticks(range(len(names)), names, fontsize=7)
    axis.set(xlabel="time-step factor: stable below (green), not at the end of the bar")
    figure.savefig(path, dpi=110)
    plt.close(figure)
    print(path)


def worst(rows):
    return max((row["verdict"] for row in rows), key=VERDICTS.index) if rows else "–"


def summary_tables(rows, found, titles):
    sweeps = [name for name in SWEEPS if any(row["sweep"] == name for row in rows)]
    texts = []
    lines = []
    for name in sweeps:
        own = [row for row in rows if row["sweep"] == name and row["map"] == "numerics" and row["numerics"] == CHECKED[0]]
        for row in own:
            if row["verdict"] == "stable":
                continue
            when = "" if row["when"] is None else f"{row['when']:.3g}"
            lines.append([titles[name], row["point"], row["verdict"], row["how"].split("; probable cause")[0][:110], when])
        if own and worst(own) == "stable":
            lines.append([titles[name], "all", "stable", "", ""])
    texts.append("**Default settings** (" + CHECKED[0] + ", factor 0.5, Huang's second method, gap detection): what is not stable\n\n"
                 + markdown_table(["sweep", "point", "verdict", "how", "from time"], lines))
    lines = []
    for which in ("numerics", "methods"):
        for name in dict.fromkeys(row["numerics"] for row in rows if row["map"] == which):
            own = [row for row in rows if row["map"] == which and row["numerics"] == name]
            count = {verdict: sum(row["verdict"] == verdict for row in own) for verdict in VERDICTS}
            bound = next((f"{b['largest_stable']:.2g}" if b["largest_stable"] is not None else f"< {b['smallest_unstable']:.2g}"
                          for b in found if b["map"] == which and b["numerics"] == name), "–")
            fails = [titles[s] for s in sweeps if any(row["sweep"] == s and row["verdict"] == "fails" for row in own)]
            lines.append([name, *(str(count[verdict]) for verdict in VERDICTS), bound, ", ".join(fails)])
    texts.append("**All settings**: cases by verdict, largest stable factor of the rings, sweeps with failures\n\n"
                 + markdown_table(["numerics or method", *VERDICTS, "rings: factor", "fails somewhere in"], lines))
    return "\n\n".join(texts)


def write_table(rows, found):
    with open(TABLE, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["sweep", "map", "numerics", "point", "verdict", "how", "when", "energy_growth", "energy_residual"])
        for row in rows:
            writer.writerow([row["sweep"], row["map"], row["numerics"], row["point"], row["verdict"], row["how"][:160],
                             *("" if row[key] is None else f"{row[key]:.3g}" for key in ("when", "energy_growth", "energy_residual"))])
        for row in found:
            writer.writerow(["alpha", row["map"], row["numerics"], "largest stable factor",
                             "" if row["largest_stable"] is None else f"{row['largest_stable']:.3g}", row["how"][:160], "", "", ""])


def check(arguments, output, cache):
    with open(TABLE, encoding="utf-8") as file:
        known = {(row["sweep"], row["map"], row["numerics"], row["point"]): row["verdict"] for row in csv.DictReader(file)}
    problems, count = [], 0
    for name in arguments.sweeps:
        if name == "alpha":
            continue
        for numerics in CHECKED:
            study = load(run_study(arguments.program, name, os.path.join(output, numerics), cache, arguments.jobs, [f"numerics={numerics}"]))
            for row in records({name: study}):
                count += 1
                expected = known.get((row["sweep"], row["map"], row["numerics"], row["point"]))
                if expected is None:
                    problems.append(f"{name}, {numerics}, {row['point']}: is not in {os.path.basename(TABLE)}")
                elif VERDICTS.index(row["verdict"]) > VERDICTS.index(expected):
                    problems.append(f"{name}, {numerics}, {row['point']}: {row['verdict']} ({row['how']}), was {expected}")
    for problem in problems:
        print(problem)
    print(f"{count} cases, {len(problems)} worse than before")
    if count < 100:
        raise Refused(f"only {count} cases were checked; expected over a hundred")
    sys.exit(1 if problems else 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sweeps", nargs="+", choices=SWEEPS, default=SWEEPS, metavar="SWEEP", help="of " + ", ".join(SWEEPS))
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="cases at once (default: processors)")
    parser.add_argument("--program", default=os.path.join(TOP, "build", "release", "bin", "ogive"))
    parser.add_argument("--output", default=os.path.join(TOP, "out", "atlas"), help="directory of the runs (default out/atlas)")
    parser.add_argument("--tables-only", action="store_true", help="no runs: maps and tables of what is there")
    parser.add_argument("--check", action="store_true", help="the quick part, against the table in docs/data")
    arguments = parser.parse_args()
    if not arguments.tables_only and not os.path.exists(arguments.program):
        raise Refused(f"{arguments.program}: not there; build with: cmake --preset release && cmake --build --preset release")
    cache = os.path.join(arguments.output, "cases")
    if arguments.check:
        check(arguments, arguments.output, cache)
    for name in [] if arguments.tables_only else arguments.sweeps:
        print(name, flush=True)
        run_study(arguments.program, name, arguments.output, cache, arguments.jobs)
    studies = {name: study for name in SWEEPS if (study := load(os.path.join(arguments.output, name)))}
    if not studies:
        raise Refused(f"{arguments.output}: no sweeps are there")
    titles = {name: study["title"] for name, study in studies.items()}
    rows, found = records(studies), bisections(studies)
    images = os.path.join(TOP, "docs", "images")
    draw_map(rows, "numerics", titles, os.path.join(images, "stability_numerics.png"))
    draw_map(rows, "methods", titles, os.path.join(images, "stability_methods.png"))
    draw_alpha(found, os.path.join(images, "stability_factor.png"))
    write_table(rows, found)
    replace_block(DOCUMENT, "atlas", summary_tables(rows, found, titles))


if __name__ == "__main__":
    run_main(main)
