# SPDX-License-Identifier: GPL-3.0-or-later
# A data file of LAMMPS [Å] from conf.gro of VOTCA's tutorials: -v types="A1 A2,B" -v masses="29.062,28.054", the names of
# the atoms of each type; -v chain=3: molecules of so many beads, with bonds between neighbours, and an angle.
BEGIN {
    count = split(types, names, ",")
    split(masses, mass, ",")
    for (t = 1; t <= count; t++) {
        split(names[t], name, " ")
        for (k in name) number[name[k]] = t
    }
}
NR == 2 { n = $1 }
NR > 2 && NR <= n + 2 {
    atom = substr($0, 11, 5)
    gsub(/ /, "", atom)
    type[NR - 2] = number[atom]
    place[NR - 2] = 10 * substr($0, 21, 8) " " 10 * substr($0, 29, 8) " " 10 * substr($0, 37, 8)
}
NR == n + 3 { edge = 10 * $1 }
END {
    molecules = chain ? n / chain : 0
    printf "From conf.gro\n\n%d atoms\n%d atom types\n", n, count
    if (chain) printf "%d bonds\n1 bond types\n%d angles\n1 angle types\n", molecules * (chain - 1), molecules * (chain - 2)
    printf "\n0 %g xlo xhi\n0 %g ylo yhi\n0 %g zlo zhi\n\nMasses\n\n", edge, edge, edge
    for (t = 1; t <= count; t++) print t, mass[t]
    print "\nAtoms\n"
    for (k = 1; k <= n; k++) print k, (chain ? int((k - 1) / chain) + 1 " " : "") type[k], place[k]
    if (!chain) exit
    print "\nBonds\n"
    for (k = 1; k < n; k++) if (k % chain) print ++bonds, 1, k, k + 1
    print "\nAngles\n"
    for (k = 1; k < n - 1; k++) if (k % chain && (k + 1) % chain) print ++angles, 1, k, k + 1, k + 2
}
