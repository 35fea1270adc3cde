#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# course.sh FIT: how far from the target water's potential was as a fit's folder holds it after each of some
# iterations, by an independent simulation of it (Monte Carlo, without a time step): FIT/course.tsv. MESOFIT is the
# program.
set -eu
mesofit=${MESOFIT:-mesofit}
fit=$1
here=$(dirname "$0")
target=$here/../../targets/spc-water/spc298_rdf_com_1.0nm_100.txt
[ ! -e "$fit/course.tsv" ] || exit 0
mkdir -p "$fit/course"

# The first iteration, each that took 1.5 times as long as the one before, and the last.
iterations=$(awk '!/^#/ { if ($3 >= 1.5 * last) { print $1; last = $3; shown = $1 }; end = $1 }
    END { if (end != shown) print end }' "$fit/timing.tsv")
printf '# iteration\tprocessor_seconds[s]\trdf_rmse[1]\tnoise[1]\n' >"$fit/course.part"
for k in $iterations; do
    awk -F '\t' -v OFS='\t' -v k="$k" '
        /^#/ { for (c = 2; c <= NF; c++) { name = $c; sub(/\[.*/, "", name); if (name == k) column = c }
               print "# r[lambda]", "phi[k_B.T_0]"; next }
        { print $1, $column }' "$fit/potential_history.tsv" >"$fit/course/potential.tsv"
    cat >"$fit/course/scene.json" <<'END'
{
    "seed": 7,
    "box": [6.0614, 6.0614, 6.0614],
    "particles": {"count": 729},
    "temperature": 1,
    "conservative": {"law": "table", "file": "potential.tsv"},
    "dynamics": {"integrator": "monte-carlo"},
    "rdf": {"range": 2.1505376, "bins": 100},
    "measure": {"equilibration": 300, "samples": 900, "every": 5}
}
END
    "$mesofit" simulate "$fit/course/scene.json" -o "$fit/course/$k" --threads 1 --quiet --force
    awk -v k="$k" -v OFS='\t' '
        /^#/ { next }
        FILENAME ~ /timing/ { seconds[$1] = $3; next }
        FILENAME ~ /rdf.tsv/ { g[n] = $2; error[n++] = $3; next }
        NF >= 6 { d = $5 - g[m]; s += d * d; e += $6 * $6 + error[m] * error[m]; m++ }
        END { print k, seconds[k], sqrt(s / m), sqrt(e / m) }' \
        "$fit/timing.tsv" "$fit/course/$k/rdf.tsv" "$target" >>"$fit/course.part"
done
mv "$fit/course.part" "$fit/course.tsv"
