#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# NaCl in water by GROMACS, 5 ns (two hours of a core), its g(r) of ions, and the three potentials in implicit water by LAMMPS.
# MESOFIT is the program, GMX and LMP the others. What GROMACS has run (out/atomistic/ions.xtc) is not run again.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-../../mesofit} gmx=${GMX:-gmx} lmp=${LMP:-lmp}

# 1000 molecules of water, of whose beginning 36 become ions.
prepare() {
    cp topol.top run.mdp out/atomistic
    cd out/atomistic
    sed 's/^integrator.*/integrator = steep/; s/^nsteps.*/nsteps = 200/; s/^[tp]coupl.*//' run.mdp >minimise.mdp
    "$gmx" solvate -cs spc216.gro -box 3.2 -maxsol 1036 -o water.gro
    "$gmx" grompp -f minimise.mdp -c water.gro -p topol.top -o water.tpr
    echo SOL | "$gmx" genion -s water.tpr -p topol.top -o start.gro -pname NA -np 18 -nname CL -nn 18 -seed 1
    "$gmx" grompp -f minimise.mdp -c start.gro -p topol.top -o minimise.tpr
    "$gmx" mdrun -ntmpi 1 -deffnm minimise
    "$gmx" grompp -f run.mdp -c minimise.gro -p topol.top -o ions.tpr
    cd ../..
}

# FILE.gro: its ions as a data file of LAMMPS, in the box of run.json, which is the mean one.
data_of() {
    awk -v L="$(sed -n 's/.*"box": \[\([0-9.]*\),.*/\1/p' run.json)" '{ line[NR] = $0 } END { scale = 10 * L / $1; L *= 10
        printf "Ions of %s\n\n36 atoms\n2 atom types\n\n0 %.6g xlo xhi\n0 %.6g ylo yhi\n0 %.6g zlo zhi\n", FILENAME, L, L, L
        printf "\nMasses\n\n1 22.9898\n2 35.453\n\nAtoms # charge\n\n"
        for (k = 3; k < NR; k++) if (split(line[k], f) && f[2] ~ /^(NA|CL)$/)
            printf "%d %d %d %.2f %.2f %.2f\n", ++n, f[2] == "NA" ? 1 : 2, f[2] == "NA" ? 1 : -1, scale * f[4], scale * f[5], scale * f[6] }' "$1"
}

mkdir -p out/atomistic
if [ ! -e out/atomistic/ions.gro ]; then
    prepare
    (cd out/atomistic && "$gmx" mdrun -ntmpi 1 -deffnm ions)
fi
(sed -n 1p out/atomistic/ions.gro; echo 36; grep -E "[0-9](NA|CL) " out/atomistic/ions.gro; tail -n 1 out/atomistic/ions.gro) >out/names.gro
"$mesofit" measure out/atomistic/ions.xtc -s out/names.gro --begin 200 --range 1.5 --bins 75 --temperature 298.15 -o out/target --force
cp out/target/rdf_*.tsv .
data_of out/names.gro >data.ions
"$mesofit" fit run.json --engine "$lmp" --force
gnuplot potentials.gp
