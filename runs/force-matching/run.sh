#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: a liquid with a known law is simulated and measured with its forces, and its potential found by
# force matching, inverse Monte Carlo and relative entropy: out/force-matching, out/imc, out/relative-entropy,
# and force-matching.png. MESOFIT is the program.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
"$mesofit" simulate truth.json -o out/truth --quiet --force
"$mesofit" measure out/truth/snapshots/trajectory.lammpstrj --forces 2.5 --range 2.5 --bins 125 --static --q-range 0 \
    --temperature 120.272 -o out/target --force
for method in force-matching imc relative-entropy; do
    parameters=
    [ $method = force-matching ] || parameters=', "particles": 400, "precision": 0.004'
    sed "s/^{/{\"seed\": 1, \"unknowns\": {\"potential\": {\"truth\": {\"law\": \"lennard-jones\", \"epsilon\": 1, \"sigma\": 1, \"cutoff\": 2.5}}}, \"method\": {\"name\": \"$method\"$parameters}, /" \
        out/target/target.json >"out/target/$method.json"
    "$mesofit" fit "out/target/$method.json" -o "out/$method" --force || [ $? -eq 1 ]
done
gnuplot -d figure.gp
