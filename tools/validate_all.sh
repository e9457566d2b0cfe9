#!/usr/bin/env bash
# All tables, plots and data of docs/validation.md from the built release, and what `accuracy` and the plan of a run go by
# (docs/accuracy.md, docs/performance.md): of the former runs what is not there yet, of the latter everything.
#
#   tools/validate_all.sh           the fast part: contact methods on the papers' cases (some 4 minutes; CI checks it)
#   tools/validate_all.sh --full    finer cells, thick plate, its grid series, steel ball, the plan too (four hours or so)
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1-} in
  "") exec tools/validate_contact.py ;;
  --full) ;;
  *) sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
tools/validate_contact.py --full
tools/validate_thick_plate.py
tools/validate_convergence.py --cells 4 3 2 1.5 1
tools/validate_convergence.py --contact
tools/validate_steel_ball.py
tools/beam_table.py --only plane
tools/beam_table.py --only 3d --cells 50 25
tools/resolution_table.py
tools/resolution_table.py --factors
cmake --build --preset release  # the program carries what was just measured
tools/resolution_table.py --deliver
tools/plan_table.py
tools/coarse_table.py
