#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# traj.xtc, by GROMACS: 60 ps with friction, 50 ps without, and the 16 ps that are kept. Some four minutes.
set -e
cd "$(dirname "$0")"
sources=$(pwd)
place=$(mktemp -d)
cp ./*.mdp one.gro topol.top "$place"
cd "$place"
export OMP_NUM_THREADS=1
gmx insert-molecules -ci one.gro -nmol 200 -box 3.23 3.23 3.23 -try 2000 -radius 0.08 -seed 1 -o start.gro
gmx grompp -f em.mdp -c start.gro -p topol.top -o em.tpr
gmx mdrun -deffnm em -ntmpi 1
gmx grompp -f settle.mdp -c em.gro -p topol.top -o settle.tpr
gmx mdrun -deffnm settle -ntmpi 1
gmx grompp -maxwarn 1 -f md.mdp -c settle.gro -t settle.cpt -p topol.top -o bath.tpr
gmx mdrun -deffnm bath -ntmpi 1 -nsteps 25000
gmx grompp -maxwarn 1 -f md.mdp -c bath.gro -t bath.cpt -p topol.top -o traj.tpr
gmx mdrun -deffnm traj -ntmpi 1
mv traj.xtc "$sources"
cd "$sources"
rm -r "$place"
