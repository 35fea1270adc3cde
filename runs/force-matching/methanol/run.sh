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
export MESOFIT="$mesofit" GMX="$gmx"
sh ../../atoms.sh 1.2
sh ../../fits.sh target 576 1.2
cd ..
gnuplot -d -e 'liquid = "methanol"; low = 0.25; range = 1.2; depth = 1.2; top = 2.2; off = 0.1' ../liquid.gp
