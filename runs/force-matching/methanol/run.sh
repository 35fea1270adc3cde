#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: methanol of three sites (GROMOS 43a1) is simulated by GROMACS with its forces, and the
# potential of one bead a molecule found by force matching, without and with the pressure, inverse
# Monte Carlo and relative entropy: out/force-matching, out/pressure, out/imc, out/relative-entropy,
# and methanol.png. MESOFIT and GMX are the programs, GMXDATA is GROMACS's folder of data.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit} gmx=${GMX:-gmx} data=${GMXDATA:-/usr/share/gromacs}
mkdir -p out
cp map.json nvt.mdp npt.mdp em.mdp out
cd out
cp "$data/top/gromos43a1.ff/methanol216.gro" .
"$gmx" solvate -cs methanol216.gro -box 3.3 3.3 3.3 -o start.gro
printf '#include "gromos43a1.ff/forcefield.itp"\n#include "gromos43a1.ff/methanol.itp"\n[ system ]\nMethanol\n[ molecules ]\nMethanol %d\n' \
    $(($(sed -n 2p start.gro) / 3)) >topol.top
at=start
for stage in em npt nvt; do
    "$gmx" grompp -f $stage.mdp -c $at.gro -p topol.top -o $stage.tpr -maxwarn 3
    "$gmx" mdrun -deffnm $stage
    at=$stage
done
"$mesofit" measure nvt.trr -s npt.gro --map map.json --forces 1.2 --range 1.2 --static --q-range 0 \
    --temperature 300 -o target --force
for fit in force-matching pressure imc relative-entropy; do
    method="\"name\": \"$fit\", \"particles\": 576, \"precision\": 0.006"
    [ $fit != relative-entropy ] || method="$method, \"coefficients\": 60"
    [ $fit = imc ] || [ $fit = relative-entropy ] || method='"name": "force-matching"'
    pressure=
    [ $fit != pressure ] || pressure='"pressure": {"value": 1, "error": 20}, '
    sed "s/^{/{\"seed\": 1, \"unknowns\": {\"potential\": {}}, \"method\": {$method}, /; s/\"rdf\":/$pressure\"rdf\":/; s/\"file\":[^,]*rdf.tsv\"/&, \"cutoff\": 1.2/" \
        target/target.json >target/$fit.json
    "$mesofit" fit target/$fit.json -o $fit --force || [ $? -eq 1 ]
done
cd ..
gnuplot -d figure.gp
