#!/bin/sh
# Bulk at 1 bar, bulk at its mean density, a slab of twice the bulk: an hour of one core, GROMACS 2022.5.
set -eu
G="gmx -quiet -nobackup"
for run in npt0 npt nvt slab; do cat common.mdp $run.mdp >full-$run.mdp; done
$G insert-molecules -ci molecule.gro -nmol 500 -box 3.4 3.4 3.4 -try 200 -o random.gro
$G grompp -f em.mdp -c random.gro -p topol.top -o em.tpr -maxwarn 2
$G mdrun -nt 1 -deffnm em
$G grompp -f full-npt0.mdp -c em.gro -p topol.top -o npt0.tpr -maxwarn 2
$G mdrun -nt 1 -deffnm npt0
$G grompp -f full-npt.mdp -c npt0.gro -t npt0.cpt -p topol.top -o npt.tpr
$G mdrun -nt 1 -deffnm npt
echo Box-X | $G energy -f npt.edr -b 20 -o box.xvg
mean=$(awk '!/^[#@]/ { s += $2^3; n++ } END { printf "%.5f", (s/n)^(1/3) }' box.xvg)
scale=$(tail -n 1 npt.gro | awk -v mean="$mean" '{ printf "%.8f", mean/$1 }')
echo 0 | $G trjconv -f npt.gro -s npt.tpr -pbc mol -o whole.gro
$G editconf -f whole.gro -scale "$scale" "$scale" "$scale" -o begin.gro
sed -i "\$s/.*/  $mean $mean $mean/" begin.gro
$G grompp -f full-nvt.mdp -c begin.gro -p topol.top -o nvt.tpr -maxwarn 1
$G mdrun -nt 1 -deffnm nvt
echo 0 | $G trjconv -f nvt.gro -s nvt.tpr -pbc mol -o whole.gro
$G genconf -f whole.gro -nbox 1 1 2 -o two.gro
$G editconf -f two.gro -box "$mean" "$mean" 13 -c -o slab0.gro
sed 's/^MOH 500/MOH 1000/' topol.top >slab.top
$G grompp -f full-slab.mdp -c slab0.gro -p slab.top -o slab.tpr -maxwarn 1
$G mdrun -nt 1 -deffnm slab
printf 'Pres-XX\nPres-YY\nPres-ZZ\n0\n' | $G energy -f slab.edr -o pressures.xvg
awk -v edge=13 -v begin=50 -f tension.awk pressures.xvg
mesofit measure nvt.xtc -s begin.gro --map map.json --static --temperature 300 --weighted-density 0.33,0.40 -o bulk
mesofit measure slab.xtc -s slab0.gro --map map.json --static --temperature 300 --begin 50 --range 1 --q-range 0 \
    --density-profile z --profile-bins 260 -o slab
