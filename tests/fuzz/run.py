#!/usr/bin/env python3
"""Builds the fuzzers with clang and libFuzzer, with the address and undefined-behaviour sanitizers, and runs them in turn.

  tests/fuzz/run.py --build-dir DIR --work DIR [--seconds 3600] [--only mesh,scene] [--no-build]

WORK/<target>/ keeps the grown corpus and findings (crash-*, timeout-*, ...); WORK/log.csv gets a line for each run: target, CPU
seconds, inputs tried, findings. Exit code 1 where there was a finding."""

import argparse
import csv
import os
import pathlib
import re
import resource
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGETS = ["mesh", "scene", "checkpoint", "particles", "interface"]
# Longest inputs, and files of words that the text formats are made of.
LENGTH = {"mesh": 4096, "scene": 4096, "checkpoint": 2048, "particles": 1024, "interface": 1024}


def build(directory, jobs):
    environment = dict(os.environ, CC="clang", CXX="clang++")
    subprocess.run(["cmake", "-S", ROOT, "-B", directory, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=RelWithDebInfo",
                    "-DOGIVE_FUZZ=ON", "-DOGIVE_SANITIZE=address,undefined", "-DOGIVE_CPU_LEVELS=OFF",
                    "-DOGIVE_FORTRAN=OFF", "-DOGIVE_EXAMPLES=OFF",
                    "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1 -DNDEBUG"], env=environment, check=True)
    subprocess.run(["cmake", "--build", directory, "-j", str(jobs), "--target"] + [f"ogive_{t}_fuzz" for t in TARGETS],
                   check=True)


def children_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(target, arguments, log):
    work = arguments.work / target
    corpus = work / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    command = [arguments.build_dir / "bin" / f"ogive_{target}_fuzz", corpus, ROOT / "tests/fuzz/corpus" / target,
               f"-max_total_time={arguments.seconds}", f"-max_len={LENGTH[target]}", "-timeout=120", "-rss_limit_mb=3000",
               "-print_final_stats=1", f"-artifact_prefix={work}/", f"-seed={arguments.seed}"]
    words = ROOT / "tests/fuzz" / f"{target}.dict"
    if words.exists():
        command.append(f"-dict={words}")
    before = children_seconds()
    with open(work / "output.txt", "wb") as output:
        # Worlds have one thread; the undefined-behaviour sanitizer stops at the first finding as the address sanitizer does.
        code = subprocess.run([str(c) for c in command], stdout=output, stderr=subprocess.STDOUT,
                              env=dict(os.environ, OMP_NUM_THREADS="1")).returncode
    text = (work / "output.txt").read_text(errors="replace")
    tried = re.search(r"stat::number_of_executed_units:\s*(\d+)", text) or re.search(r"Done (\d+) runs", text)
    if not tried:
        counts = re.findall(r"^#(\d+)\s", text, re.MULTILINE)
    number = int(tried.group(1)) if tried else int(counts[-1]) if counts else 0
    row = [target, f"{children_seconds() - before:.0f}", number, int(code != 0)]
    with open(log, "a", newline="") as file:
        csv.writer(file).writerow(row)
    print(*row, sep="\t", flush=True)
    return code


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build-dir", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--seconds", type=int, default=3600, help="of wall time for each target")
    parser.add_argument("--only", default=",".join(TARGETS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--no-build", action="store_true")
    arguments = parser.parse_args()
    if not arguments.no_build:
        build(arguments.build_dir, arguments.jobs)
    arguments.work.mkdir(parents=True, exist_ok=True)
    print("target\tCPU seconds\tinputs\tfindings")
    codes = [run(target, arguments, arguments.work / "log.csv") for target in arguments.only.split(",")]
    return 1 if any(codes) else 0


if __name__ == "__main__":
    sys.exit(main())
