#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: three time steps, and what they are extrapolated to; out/richardson.tsv and richardson.png.
# MESOFIT is the program.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
for step in 0.0125 0.025 0.05; do
    "$mesofit" simulate "step-$step.json" -o "out/$step" --quiet --force
done
# Each time step is twice the one before: (8 κ_1 − 6 κ_2 + κ_3)/3 is free of Δt and Δt².
paste out/0.0125/force_covariance.tsv out/0.025/force_covariance.tsv out/0.05/force_covariance.tsv | awk -F '\t' -v OFS='\t' '
    /^#/ { if (!n++) print "# r[lambda]", "exact", "kappa_0.0125", "error", "kappa_0.025", "error", "kappa_0.05", "error", "extrapolated", "error"; next }
    { print $1, $4, $2, $3, $6, $7, $10, $11, (8 * $2 - 6 * $6 + $10) / 3, sqrt(64 * $3 * $3 + 36 * $7 * $7 + $11 * $11) / 3 }' >out/richardson.tsv
gnuplot -d figure.gp
echo "r  2kTω²  extrapolated"
awk '/^#/ { next } $1 > 0.2 { printf "%.3f  %.3f  %.2f(%.2f)\n", $1, $2, $9, $10 }' out/richardson.tsv
