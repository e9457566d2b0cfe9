#!/usr/bin/env bash
# All tests from nothing: packages, release build, every CTest label, then the unit tests (engine, geometry, files, scenes), the
# fuzzers' replays and the tests of the C interface under the address and undefined-behaviour sanitizers, and several worlds on
# several threads under the thread sanitizer. Goes on after a failure where it can; the summary tells.
#
#   tools/test.sh [--build-dir DIR] [--jobs N] [--no-sanitizers]
#
# DIR (default: $OGIVE_BUILD_DIR, else build) gets release/, asan/ and tsan/. N (default: all processors) builds and tests at once.
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '2,8s/^# \{0,1\}//p' "$0"; }
build=${OGIVE_BUILD_DIR:-build}
jobs=$(nproc)
sanitizers=yes
while [ $# -gt 0 ]; do
  case $1 in
    --build-dir) build=${2:?--build-dir needs a directory}; shift 2 ;;
    --jobs) jobs=${2:?--jobs needs a number}; shift 2 ;;
    --no-sanitizers) sanitizers=no; shift ;;
    -h | --help) usage; exit 0 ;;
    *) echo "test.sh: unknown argument $1" >&2; usage >&2; exit 2 ;;
  esac
done

results=()
failed=no
# phase NAME COMMAND...: runs it, keeps its outcome and time; false if it failed.
phase() {
  local name=$1 start=$SECONDS outcome=passed
  shift
  printf '\n=== %s\n' "$name"
  "$@" || { outcome="FAILED (exit code $?)"; failed=yes; }
  results+=("$(printf '%-42s %4d s  %s' "$name" $((SECONDS - start)) "$outcome")")
  [ "$outcome" = passed ]
}

release() {
  phase "release: configure" cmake --preset release -B "$build/release" -DOGIVE_BENCH=ON || return 0
  phase "release: build" cmake --build "$build/release" -j "$jobs" || return 0
  phase "release: all tests" ctest --test-dir "$build/release" --output-on-failure --no-tests=error -j "$jobs" || return 0
}

# What is compiled once for each instruction set in a release is here compiled once: the sanitizers look at the source. With
# more optimisation, or all debug information, the instrumented kernels alone compile for minutes.
asan() {
  phase "sanitizers: configure" cmake --preset asan -B "$build/asan" -DOGIVE_CPU_LEVELS=OFF \
    -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" || return 0
  phase "sanitizers: build" cmake --build "$build/asan" -j "$jobs" \
    --target ogive_unit_tests geometry_tests io_tests ogive_scene_tests ogive_capi_tests ogive_capi_good_test \
             ogive_capi_bad_test ogive_old_client ogive_layout_c ogive_layout_fortran ogive_fortran_test \
             ogive_mesh_fuzz ogive_particles_fuzz ogive_scene_fuzz ogive_checkpoint_fuzz ogive_interface_fuzz || return 0
  phase "sanitizers: unit, interface, fuzz tests" ctest --test-dir "$build/asan" --output-on-failure --no-tests=error \
    -L '^(unit|capi|fuzz)$' -j "$jobs" || true
  phase "sanitizers: scene tests" "$build/asan/bin/ogive_scene_tests" --gtest_brief=1 || true
}

tsan() {
  phase "thread sanitizer: configure" cmake --preset tsan -B "$build/tsan" -DOGIVE_CPU_LEVELS=OFF -DOGIVE_IO=OFF \
    -DOGIVE_GEOMETRY=OFF -DOGIVE_DRIVER=OFF -DOGIVE_FORTRAN=OFF -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" || return 0
  phase "thread sanitizer: build" cmake --build "$build/tsan" -j "$jobs" --target ogive_thread_tests || return 0
  phase "thread sanitizer: worlds on threads" "$build/tsan/bin/ogive_thread_tests" --gtest_brief=1 || true
}

phase "packages" tools/install_packages.sh || exit 1
release
[ $sanitizers = no ] || { asan; tsan; }

printf '\n=== summary (%d jobs, %d s)\n' "$jobs" "$SECONDS"
printf '%s\n' "${results[@]}"
if [ $failed = yes ]; then echo "tests FAILED"; exit 1; fi
echo "all tests passed"
