#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# atoms.sh RANGE: atoms of start.gro and topol.top in this folder, at rest by em.mdp, at their pressure by
# npt.mdp and with their forces by nvt.mdp, and what is measured of the beads of map.json up to RANGE, in
# target. MESOFIT and GMX are the programs.
set -eu
range=$1 mesofit=${MESOFIT:-mesofit} gmx=${GMX:-gmx}
at=start
for stage in em npt nvt; do
    "$gmx" grompp -f $stage.mdp -c $at.gro -p topol.top -o $stage.tpr -maxwarn 3
    "$gmx" mdrun -deffnm $stage
    at=$stage
done
"$mesofit" measure nvt.trr -s npt.gro --map map.json --forces "$range" --range "$range" --static --q-range 0 \
    --temperature 300 -o target --force
