#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: octane of united atoms, the scene of ../../standard-set/octane, is simulated with its forces, and
# the potentials of four beads a molecule, with their bonds and angles, found by force matching, by
# inversion (auto) and by relative entropy: folders in out, and octane.png. MESOFIT is the program.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
octane=$(cd ../../standard-set/octane && pwd)
mkdir -p out
sed 's/"extxyz"/"lammps-dump"/' "$octane/united-atoms.json" >out/united-atoms.json
"$mesofit" simulate out/united-atoms.json -o out/atoms --quiet --force
awk -f order.awk out/atoms/snapshots/trajectory.lammpstrj >out/octane.lammpstrj
"$mesofit" measure out/octane.lammpstrj --map "$octane/map.json" --molecules "$octane/molecules.json" \
    --forces 1.2 --range 1.2 --static --q-range 0 --temperature 300 -o out/target --force
for fit in force-matching auto relative-entropy; do
    method="\"name\": \"$fit\", \"particles\": 500, \"precision\": 0.008"
    [ $fit != force-matching ] || method='"name": "force-matching"'
    [ $fit != relative-entropy ] || method="$method, \"coefficients\": 40"
    sed "s/^{/{\"seed\": 1, \"unknowns\": {\"potential\": {}}, \"method\": {$method}, /; s/\"file\":[^,]*rdf_[^,]*.tsv\"/&, \"cutoff\": 1.2/" \
        out/target/target.json >out/target/$fit.json
    "$mesofit" fit out/target/$fit.json -o out/$fit --force || [ $? -eq 1 ]
done
gnuplot -d figure.gp
