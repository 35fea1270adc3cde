#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# smoke.sh VERSION [PYTHON]: the `mesofit` that PATH finds, and the package of PYTHON, are of that version
# and fit g(r) of water in seconds. Run anywhere.
set -eu

version=$1
python=${2:-}
root=$(realpath "$(dirname "$0")/..")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
grep -v '^#' "$root/targets/spc-water/spc298_rdf_com_1.0nm_100.txt" | awk '{print $2, $5}' >rdf.tsv
cat >run.json <<'JSON'
{"target": {"rdf": {"file": "rdf.tsv"}},
 "scene": {"box": [4.4, 4.4, 4.4], "particles": {"count": 2744}, "temperature": 1},
 "method": {"name": "hnc", "precision": 0.02}, "verification": {"replicas": 1, "samples": 50}}
JSON

says=$(mesofit --version)
[ "$says" = "mesofit $version" ] || { echo "$(command -v mesofit) is $says, not $version"; exit 1; }
mesofit fit run.json -o fit --quiet >says 2>&1 || { cat says; exit 1; }
[ -s fit/potential.tsv ]
grep -qF "\"$version\"" fit/summary.json
[ -z "$python" ] && exit
"$python" - "$version" <<'PYTHON'
import sys
import mesofit
assert mesofit.__version__ == sys.argv[1], mesofit.__version__
assert len(mesofit.open("fit").table("potential")["r"]) > 10
PYTHON
