#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# fits.sh TARGET BEADS RANGE: the potential of a folder of `measure --forces`, of one type of beads and
# so many of them, by force matching, without and with a pressure of 1 bar, by inverse Monte Carlo and by
# relative entropy, in folders of these names here. MESOFIT is the program.
set -eu
target=$1 beads=$2 range=$3
mesofit=${MESOFIT:-mesofit}
for fit in force-matching pressure imc relative-entropy; do
    method="\"name\": \"$fit\", \"particles\": $beads, \"precision\": 0.006"
    [ $fit != relative-entropy ] || method="$method, \"coefficients\": 60"
    [ $fit = imc ] || [ $fit = relative-entropy ] || method='"name": "force-matching"'
    pressure=
    [ $fit != pressure ] || pressure='"pressure": {"value": 1, "error": 20}, '
    sed "s/^{/{\"seed\": 1, \"unknowns\": {\"potential\": {}}, \"method\": {$method}, /; s/\"rdf\":/$pressure\"rdf\":/; s/\"file\":[^,]*rdf.tsv\"/&, \"cutoff\": $range/" \
        "$target/target.json" >"$target/$fit.json"
    "$mesofit" fit "$target/$fit.json" -o $fit --force || [ $? -eq 1 ]
done
