#!/usr/bin/python3
"""Prints what the demo's runs gave beside experiment and paper, and draws their pictures.

  demo_report.py OUT TABLE      OUT holds the run directories; TABLE is tests/data/huang2010_thick_plate.csv
"""

import argparse
import os
import subprocess
import sys

from plot_common import Refused, run_main, summary_of
from validation_table import read_references

RUNS = [("recommended", "the scene's own settings"), ("paper-settings", "settings of the paper")]


def draw(tool, *arguments):
    subprocess.run([sys.executable, os.path.join(os.path.dirname(__file__), tool), *arguments], check=True,
                   stdout=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out")
    parser.add_argument("table")
    arguments = parser.parse_args()

    directories = {name: os.path.join(arguments.out, name) for name, _ in RUNS}
    summaries = {name: summary_of(directory) for name, directory in directories.items()}
    for name, summary in summaries.items():
        if not summary:
            raise Refused(f"{directories[name]}: no summary.json")

    v0 = summaries[RUNS[0][0]]["parameters"]["V0"]
    print(f"Residual velocity of the rod, impact at {v0:g} m/s")
    for name, text in RUNS:
        summary = summaries[name]
        print(f"  {summary['results']['residual_velocity']:7.1f} m/s  Ogive, {text} "
              f"(stopped: {summary['stop_reason']} at {1000 * summary['time']:.0f} us; unaccounted energy "
              f"{100 * summary['energy']['residual_relative']:+.2f} %; {summary['wall_seconds']:.0f} s)")
    reference = read_references(arguments.table).get(v0)
    if reference:
        print(f"  {reference['experiment']:7.1f} m/s  experiment (Piekutowski et al. 1996)")
        print(f"  {reference['huang_second']:7.1f} m/s  paper (Huang et al. 2010, second contact method)")

    pictures = [os.path.join(arguments.out, name) for name in ("section.png", "section-final.png", "history.png")]
    recommended = directories["recommended"]
    draw("plot_section.py", recommended, "-o", pictures[0])
    draw("plot_section.py", recommended, "--times", str(summaries["recommended"]["time"]), "-o", pictures[1])
    lines = []
    if reference:
        lines = ["--reference", f"experiment={reference['experiment']}", "--reference",
                 f"paper={reference['huang_second']}"]
    draw("plot_history.py", *directories.values(), "-o", pictures[2], *lines)
    print("\nPictures: section at four times and at the end (colour: plastic strain), and the velocity history:")
    for picture in pictures:
        print(f"  {picture}")


if __name__ == "__main__":
    run_main(main)
