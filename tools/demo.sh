#!/usr/bin/env bash
# The main job from nothing: builds Ogive, shoots the ogive-nosed rod obliquely through the thick plate at 575 m/s, prints
# the residual velocity beside the experiment and the paper, and draws pictures. Twice: with the scene's own settings, and
# with the numerics of Huang et al. 2010.
#
#   tools/demo.sh [options of ogive run]      for example --set parameters.V0=400
#
# The build is in $OGIVE_BUILD_DIR (default build), results and pictures are in out/demo.
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1:-} in -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;; esac
build=${OGIVE_BUILD_DIR:-build}/release
out=out/demo
scene=examples/scenes/thick_plate/scene.toml

tools/install_packages.sh
cmake --preset release -B "$build" >/dev/null
cmake --build "$build" -j "$(nproc)" --target ogive_driver

run() {  # NAME OPTIONS...
  local name=$1
  shift
  echo
  "$build/bin/ogive" run "$scene" --output "$out/$name" --overwrite --threads 0 "$@"
}
run recommended "$@"
run paper-settings --set @examples/settings/huang2010.toml "$@"

echo
/usr/bin/python3 tools/demo_report.py "$out" tests/data/huang2010_thick_plate.csv
