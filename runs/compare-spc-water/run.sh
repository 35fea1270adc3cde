#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh [METHOD...]: water's potential by these methods, else by those of the figures, with three seeds each, on one
# thread: out/METHOD-SEED. What is there is not run again. Then, of all that is there, error-against-time.png and
# compare.png, and a table of it. MESOFIT is the program, SEEDS are the seeds.
#
# Methods: original genetic memetic cma-es nlopt gauss-newton imc ibi hnc.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-../../mesofit}
[ $# -gt 0 ] || set -- original memetic gauss-newton imc ibi
for seed in ${SEEDS:-1 2 3}; do
    for method; do
        [ ! -e "out/$method-$seed/summary.json" ] || continue
        file=$method.json
        [ -e "$file" ] || file=../spc-water-$method/run.json
        # What has not converged is compared too.
        "$mesofit" fit "$file" -o "out/$method-$seed" --seed "$seed" --threads 1 || [ $? -eq 1 ]
    done
done
"$mesofit" compare out/*-[0-9] -o out/compare
for method in original memetic gauss-newton imc ibi; do
    for fit in out/"$method"-[0-9]; do
        MESOFIT=$mesofit ./course.sh "$fit"
    done
done
./without_ramp.sh out/original-[0-9] out/memetic-[0-9] out/imc-[0-9]
gnuplot -d error_against_time.gp
gnuplot -d compare.gp
