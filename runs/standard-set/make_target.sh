#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Make targets of the standard set again whose truth is known, and octane's: make_target.sh FOLDER...
# PROGRAM is the program, build/mesofit by default; targets that are here are replaced.
set -eu
export LC_ALL=C.UTF-8
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${PROGRAM:-$here/../../build/mesofit}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# $1 scene, $2 what comes behind the names of the tables; options follow.
simulate() {
    scene=$1 suffix=$2
    shift 2
    rm -rf "$work/out"
    "$program" simulate "$scene" -o "$work/out" --quiet "$@"
    for table in "$work"/out/rdf*.tsv "$work"/out/bond_lengths.tsv "$work"/out/bond_angles.tsv "$work"/out/dihedral_angles.tsv; do
        [ ! -e "$table" ] || cp "$table" "$(dirname "$scene")/$(basename "$table" .tsv)$suffix.tsv"
    done
}

for folder; do
    cd "$here/$folder"
    case $folder in
    gaussian-core)
        for n in 1 2 3 4 5 6 7 8; do
            simulate "$PWD/truth.json" "-$n" --seed $((100 + n))
        done
        ;;
    two-dimensions)
        for name in lennard-jones wca shoulder-0.1 shoulder-0.3 shoulder-cold; do
            simulate "$PWD/truth-$name.json" "-$name"
        done
        ;;
    shoulder)
        for name in cold warm; do
            simulate "$PWD/truth-$name.json" "-$name"
        done
        ;;
    mixture-sizes)
        for name in attractive repulsive; do
            simulate "$PWD/truth-$name.json" "-$name"
        done
        ;;
    star-polymer)
        # Likos and others, Phys. Rev. Lett. 80, 4450 (1998), in the diameter of the core.
        awk 'BEGIN {
            print "# r[lambda]\tphi[k_B T_0]"
            a = 5 / 18 * 10 ^ 1.5
            h = sqrt(10) / 2
            for (k = 10; k <= 400; k++) {
                r = k / 100
                printf "%.2f\t%.8g\n", r, a * (r < 1 ? 1 / (1 + h) - log(r) : exp(-h * (r - 1)) / (1 + h) / r)
            }
        }' >law.tsv
        simulate "$PWD/truth.json" ""
        ;;
    argon)
        simulate "$PWD/truth.json" ""
        # Straight lines between the middles of bins, as a figure draws them.
        awk 'BEGIN { n = 0; srand(115); print "Digitised from a figure, liquid argon 85 K;"; print "\"r (Å)\";\"g(r)\"" }
            /^#/ { next }
            { r[n] = $1; g[n++] = $2 }
            END {
                for (k = 24; k < n - 1; k++) {
                    x = r[k] + (0.4 * rand() - 0.2) * (r[1] - r[0])
                    a = x < r[k] ? k - 1 : k
                    y = 1.006 * (g[a] + (g[a + 1] - g[a]) * (x - r[a]) / (r[a + 1] - r[a]))
                    line = sprintf("%.3f;%.3f", x, y)
                    gsub(/\./, ",", line)
                    print line
                }
            }' rdf.tsv >argon_figure.csv
        rm rdf.tsv
        ;;
    octane)
        "$program" simulate united-atoms.json -o "$work/out" --quiet
        # Molecule after molecule, which the snapshots have type after type, and C1 to C8.
        awk 'n == total + 2 { total = $1; n = 0 }
            { line[n++] = $0 }
            n == total + 2 {
                print line[0]
                print line[1]
                for (m = 0; m < total / 8; m++)
                    for (k = 1; k <= 8; k++) {
                        text = line[2 + (k == 1 ? 2 * m : k == 8 ? 2 * m + 1 : total / 4 + 6 * m + k - 2)]
                        sub(/[^ ]*$/, "C" k, text) # their name
                        print text
                    }
            }' total=-2 "$work/out/snapshots/trajectory.extxyz" >"$work/trajectory.extxyz"
        "$program" measure "$work/trajectory.extxyz" --map map.json --molecules molecules.json --static --temperature 300 -o "$work/target" --quiet
        sed 's|"title":.*|"title":\t"n-Octane at 300 K, four beads a molecule",|' "$work/target/target.json" >target.json
        cp "$work"/target/rdf_*.tsv "$work"/target/bond_lengths.tsv "$work"/target/bond_angles.tsv .
        ;;
    kremer-grest | dumbbells | ring-melt)
        # Bonded beads repel each other in the law; in the target no pair is counted that a bond or an angle joins.
        "$program" simulate "$PWD/truth.json" -o "$work/out" --quiet
        awk '/"molecules"/ { print "{"; inside = 1 }
            inside { sub(/}},$/, "}}"); sub(/"exclude": 0, /, ""); print }
            /}}$/ { inside = 0 }
            END { print "}" }' truth.json >"$work/molecules.json"
        "$program" measure "$work/out/snapshots/trajectory.lammpstrj" --molecules "$work/molecules.json" --file-units lj --static \
            --temperature 1 --range 4.7 --bins 235 -o "$work/target" --quiet
        for table in "$work"/target/rdf.tsv "$work"/target/bond_lengths.tsv "$work"/target/bond_angles.tsv; do
            [ ! -e "$table" ] || sed '1s/nm\]/lambda]/g' "$table" >"$(basename "$table")"
        done
        ;;
    mixture-solute)
        # By LAMMPS, since a scene has two beads of a type at least.
        (cd "$work" && lmp -in "$here/$folder/truth.lmp" >lmp.log)
        awk 'BEGIN {
            print "one solute"
            print 1000
            for (i = 1; i <= 1000; i++)
                printf "%5d%-5s%5s%5d%8.3f%8.3f%8.3f\n", i, i < 1000 ? "A" : "B", i < 1000 ? "A" : "B", i, 0, 0, 0
            print "10.77217 10.77217 10.77217"
        }' >"$work/names.gro"
        "$program" measure "$work/solute.lammpstrj" -s "$work/names.gro" --file-units lj --static --temperature 1 --range 5.3 \
            --bins 212 -o "$work/target" --quiet
        for pair in A-A A-B; do
            sed 's/r\[nm\]/r[lambda]/' "$work/target/rdf_$pair.tsv" >"rdf_$pair.tsv"
        done
        ;;
    *)
        simulate "$PWD/truth.json" ""
        ;;
    esac
done
