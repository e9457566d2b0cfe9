#!/usr/bin/env bash
# All tables, plots and data of docs/validation.md from the built release: runs what is not there yet.
#
#   tools/validate_all.sh           the fast part: contact methods on the papers' cases (some 4 minutes; CI checks it)
#   tools/validate_all.sh --full    finer cells, the thick plate, its grid series and the steel ball too (two hours or so)
set -euo pipefail
cd "$(dirname "$0")/.."

case ${1-} in
  "") exec tools/validate_contact.py ;;
  --full) ;;
  *) sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
tools/validate_contact.py --full
tools/validate_thick_plate.py
tools/validate_convergence.py --cells 4 3 2 1.5 1
tools/validate_convergence.py --contact
tools/validate_steel_ball.py
