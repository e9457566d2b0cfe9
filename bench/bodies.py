#!/usr/bin/python3
"""Measures what bodies of other formulations and contact by surfaces cost, and writes the table `bodies` of docs/performance.md.

  bench/bodies.py [--build build/release] [--work DIR] [--repeats 3] [--print]

A block of 85,184 particles flies and turns as an updated and as a total Lagrangian body, with three laws; the thick plate is struck
by a rod of each formulation with contact found by gap and by surfaces, to 0.06 ms, when all of the nose is in the plate. Processor
time a particle-step of the steps with their output, the least of some runs that go round all cases. --print leaves the page as it is.
"""

import argparse
import os
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import measure  # noqa: E402
from validation_table import replace_block  # noqa: E402

ELASTIC = "materials.aluminium={density=2.70e-3, elastic={youngs_modulus=69e3, poisson_ratio=0.3}}"
POWER = "materials.aluminium={density=2.70e-3, j2_power={youngs_modulus=69e3, poisson_ratio=0.3, A=262.0, B=52.1, n=0.41}}"
MIXED = "materials.aluminium={density=2.70e-3, j2_mixed={youngs_modulus=69e3, poisson_ratio=0.3, yield_stress=262.0, H=500.0, c=0.5}}"
LAWS = {"elastic": ELASTIC, "J2, power hardening": POWER, "J2, mixed hardening": MIXED}
KINDS = {"total Lagrangian": ["bodies.block.formulation=total_lagrangian"], "updated, affine FLIP": [],
         "updated, FLIP": ["numerics.transfer=flip"]}
BLOCK = ["parameters.L=44", "bodies.block.angular_velocity=[20, 30, 40]", "bodies.block.angular_centre=[0, 0, 0]"] + measure.NO_FILES
ROD = ["contact.method=persistent"] + measure.NO_FILES


def cases():
    found = {("block", law, kind): {"scene": measure.BLOCK, "settings": BLOCK + [setting] + extra, "until": 0.02}
             for law, setting in LAWS.items() for kind, extra in KINDS.items()}
    found |= {("rod", formulation, detection):
              {"scene": measure.PLATE, "settings": ROD + [f"bodies.rod.formulation={formulation}", f"contact.detection={detection}"],
               "until": 0.06}
              for formulation in ("rigid", "total_lagrangian", "deformable") for detection in ("gap", "surface")}
    return found


def page(best):
    blocks = [[law] + [f"{best['block', law, kind]['ns']:.1f}" for kind in KINDS] +
              [f"{best['block', law, kind]['ns'] / best['block', law, 'total Lagrangian']['ns']:.2f}" for kind in list(KINDS)[1:]]
              for law in LAWS]
    rods = [[formulation.replace("_", " "), f"{gap:.1f}", f"{surface:.1f}", f"{100 * (surface / gap - 1):+.1f} %"]
            for formulation in ("rigid", "total_lagrangian", "deformable")
            for gap, surface in [[best["rod", formulation, detection]["ns"] for detection in ("gap", "surface")]]]
    return (measure.table(["block, ns a particle-step"] + list(KINDS) + ["affine FLIP / total Lagrangian", "FLIP / total Lagrangian"], blocks) +
            "\n\n" + measure.table(["rod in the thick plate, ns a particle-step", "by gap", "by surfaces", "difference"], rods) +
            f"\n\n{measure.machine()['processor']}; {measure.machine()['compiler']}.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(measure.ROOT, "build", "release"))
    parser.add_argument("--work")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--print", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="ogive-bodies-") as temporary:
        best = measure.Bench(arguments.build, arguments.work or temporary, arguments.repeats).best_of(cases())
    text = page(best)
    print(text)
    if arguments.print:
        return
    replace_block(measure.PAGE, "bodies", text)


if __name__ == "__main__":
    main()
