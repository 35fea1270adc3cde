#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh [METHOD...]: water's friction by these methods, else by all, with three seeds each, on one thread:
# out/METHOD-SEED. What is there is not run again. Then, of all that is there, how far E(t, r_0) was off after how much
# work, omega-error-against-time.png. MESOFIT is the program, SEEDS are the seeds.
#
# Methods: linear original five cma-es gauss-newton memory.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-../../mesofit}
[ $# -gt 0 ] || set -- linear original five cma-es gauss-newton memory
for seed in ${SEEDS:-1 2 3}; do
    for method; do
        [ ! -e "out/$method-$seed/summary.json" ] || continue
        if [ "$method" = linear ]; then # no fit
            mkdir -p "out/linear-$seed"
            continue
        fi
        # What has not converged is compared too.
        "$mesofit" fit "$method.json" -o "out/$method-$seed" --seed "$seed" --threads 1 || [ $? -eq 1 ]
    done
done
for fit in out/*-[0-9]; do
    MESOFIT=$mesofit ./course.sh "$fit"
done
gnuplot -d omega_error_against_time.gp
# The end of each method: means of the seeds, and how much those scatter.
for method; do
    tail -q -n 1 out/"$method"-[0-9]/course.tsv | awk -F '\t' -v method="$method" '
        { t += $2; s += $3; ss += $3 * $3; n++ }
        END { printf "%s: %d seeds, %.0f s, rms of E %.4f, of a seed +- %.4f\n", method, n, t / n, s / n, (n > 1) ? sqrt((ss - s * s / n) / (n - 1)) : 0 }'
done
