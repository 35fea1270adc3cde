#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: SPC/E water is simulated by GROMACS with its forces, and the potential of one bead a molecule
# found in the four ways of ../fits.sh: folders in out, and water.png. MESOFIT and GMX are the programs.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit} gmx=${GMX:-gmx}
mkdir -p out
cp map.json ../methanol/em.mdp out
sed 's/nsteps = .*/nsteps = 100000/' ../methanol/nvt.mdp >out/nvt.mdp
sed 's/compressibility = .*/compressibility = 4.5e-5/' ../methanol/npt.mdp >out/npt.mdp
cd out
"$gmx" solvate -cs spc216.gro -box 2.5 2.5 2.5 -o start.gro
beads=$(($(sed -n 2p start.gro) / 3))
printf '#include "oplsaa.ff/forcefield.itp"\n#include "oplsaa.ff/spce.itp"\n[ system ]\nWater\n[ molecules ]\nSOL %d\n' \
    $beads >topol.top
export MESOFIT="$mesofit" GMX="$gmx"
sh ../../atoms.sh 1
sh ../../fits.sh target $beads 1
cd ..
gnuplot -d -e 'liquid = "water"; low = 0.2; range = 1; depth = 1.5; top = 3.3; off = 0.6' ../liquid.gp
