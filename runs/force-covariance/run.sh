#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: both time steps, and what they are extrapolated to; out/richardson.tsv and richardson.png.
# MESOFIT is the program.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
for step in 0.025 0.05; do
    "$mesofit" simulate "step-$step.json" -o "out/$step" --quiet --force
done
# (Δt_2 κ_1 − Δt_1 κ_2)/(Δt_2 − Δt_1)
paste out/0.025/force_covariance.tsv out/0.05/force_covariance.tsv | awk -F '\t' -v OFS='\t' '
    /^#/ { if (!n++) print "# r[lambda]", "exact", "kappa_0.025", "error", "kappa_0.05", "error", "extrapolated", "error"; next }
    { print $1, $4, $2, $3, $6, $7, 2 * $2 - $6, sqrt(4 * $3 * $3 + $7 * $7) }' >out/richardson.tsv
gnuplot -d figure.gp
echo "r  2kTω²  extrapolated"
awk '/^#/ { next } $1 > 0.3 { printf "%.3f  %.3f  %.2f(%.2f)\n", $1, $2, $7, $8 }' out/richardson.tsv
