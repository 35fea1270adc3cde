#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# without_ramp.sh FIT...: FIT/without_ramp.tsv: r, Φ, and Φ without the ramp A (1 − r/r_c) by which it differs from
# that of out/imc-1; A by least squares over the bins with g* > 0.1. out/ramps.tsv: A of each.
set -eu
cd "$(dirname "$0")"
printf '# fit\tA[k_B.T_0]\trms_with_ramp[k_B.T_0]\trms_without[k_B.T_0]\n' >out/ramps.tsv
for fit; do
    awk -F '\t' -v OFS='\t' -v fit="$fit" '
        FNR == 1 { file++ }
        /^#/ { next }
        file == 1 { g[n++] = $2; next }
        file == 2 { if ($1 > 0) reference[rows++] = $2; next }
        $1 > 0 { r[m] = $1; phi[m++] = $2 }
        END {
            cut = r[m - 1]
            for (k = 0; k < m; k++) if (g[k] > 0.1) {
                x = 1 - r[k] / cut; d = phi[k] - reference[k]
                xx += x * x; xd += x * d; dd += d * d; bins++ }
            A = xd / xx
            print "# r[lambda]", "phi[k_B.T_0]", "without_ramp[k_B.T_0]"
            for (k = 0; k < m; k++) print r[k], phi[k], phi[k] - A * (1 - r[k] / cut)
            printf "%s\t%.3f\t%.4f\t%.4f\n", fit, A, sqrt(dd / bins), sqrt((dd - xd * xd / xx) / bins) >>"out/ramps.tsv" }' \
        out/imc-1/rdf.tsv out/imc-1/potential.tsv "$fit/potential.tsv" >"$fit/without_ramp.tsv"
done
cat out/ramps.tsv
