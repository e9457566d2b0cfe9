#!/usr/bin/env bash
# Installs the Debian 12 packages that building, testing and plotting need, where they are absent.
# Works as root or through sudo; does nothing, and needs neither, where all are there.
set -euo pipefail

packages=(
  g++ gfortran cmake ninja-build pkg-config
  libhdf5-dev                                                         # lib/io
  libcgal-dev                                                         # geometry
  libboost-program-options-dev libtomlplusplus-dev libmuparser-dev    # driver
  nlohmann-json3-dev                                                  # driver, tests
  libgtest-dev abigail-tools doxygen                                  # tests
  valgrind                                                            # tests: counts of instructions
  libbenchmark-dev                                                    # bench
  chromium                                                            # tests: the page of a study in a browser
  python3 python3-numpy python3-h5py python3-matplotlib               # tools/*.py
)

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install_packages.sh: no Debian here: going on with what is installed. Needed, as Debian calls it:" >&2
  echo "  ${packages[*]}" >&2
  exit 0
fi

absent=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || absent+=("$package")
done
[ ${#absent[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install_packages.sh: packages are missing, and this is neither root nor is there sudo. As root, run:" >&2
    echo "  apt-get update && apt-get install -y ${absent[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "installing: ${absent[*]}"
if ! { "${as_root[@]}" apt-get -q update &&
       "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends -o DPkg::Lock::Timeout=300 "${absent[@]}"; }; then
  echo "install_packages.sh: apt-get could not install: ${absent[*]}" >&2
  exit 1
fi
