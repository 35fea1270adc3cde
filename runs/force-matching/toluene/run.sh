#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: toluene of OPLS-AA is simulated by GROMACS with its forces, and the potential of one bead a
# molecule found in the four ways of ../fits.sh: folders in out, and toluene.png. MESOFIT and GMX are the
# programs.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit} gmx=${GMX:-gmx} beads=343
mkdir -p out
cp map.json toluene.itp toluene.gro ../methanol/em.mdp out
for stage in npt nvt; do
    sed 's/constraints = .*/constraints = h-bonds/; s/nsteps = 25000/nsteps = 50000/' ../methanol/$stage.mdp >out/$stage.mdp
done
cd out
"$gmx" insert-molecules -ci toluene.gro -nmol $beads -box 4.6 4.6 4.6 -seed 1 -try 100 -o start.gro
printf '#include "oplsaa.ff/forcefield.itp"\n#include "toluene.itp"\n[ system ]\nToluene\n[ molecules ]\nToluene %d\n' \
    $beads >topol.top
export MESOFIT="$mesofit" GMX="$gmx"
sh ../../atoms.sh 1.6
sh ../../fits.sh target $beads 1.6
cd ..
gnuplot -d -e 'liquid = "toluene"; low = 0.35; range = 1.6; depth = 1.5; top = 2; off = 0.1' ../liquid.gp
