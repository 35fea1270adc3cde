#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh [SYSTEM [ITERATIONS]]: water (SPC/E), hexane or mixture (two Lennard-Jones liquids), VOTCA's own targets, by
# VOTCA (csg_inverse of Debian's package votca, its tutorial's settings, LAMMPS as its engine) and by mesofit, each on
# one thread: out/SYSTEM/votca-METHOD, out/SYSTEM/mesofit-METHOD. Then measure.sh. MESOFIT is the program; it goes on
# after what is there.
set -eu
export LC_ALL=C OMP_NUM_THREADS=1
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit} system=${1:-water}
tutorials=/usr/share/votca/csg-tutorials
out=out/$system
mkdir -p "$out"

# Puts the processor seconds of all children so far into $seconds; in a subshell there would be none.
read_seconds() {
    times >"out/times.$$"
    seconds=$(awk -F '[ms ]' 'NR == 2 { print 60 * $1 + $2 + 60 * $4 + $5 }' "out/times.$$")
}

set_up_water() { # METHOD FOLDER
    cp spce.in ../../targets/spce-votca/CG-CG.dist.tgt "$2/"
    post=
    [ "$1" = ibi ] || post='<post_update>smooth</post_update><post_update_options><smooth><iterations>2</iterations></smooth></post_update_options>'
    sed "s|METHOD|$1|; s|POST|$post|" settings.xml >"$2/settings.xml"
    # A simple cubic lattice of 13³ sites, 17 of them empty; [Å].
    awk 'BEGIN {
        n = 2180; edge = 40.31
        printf "Beads on a lattice\n\n%d atoms\n1 atom types\n\n", n
        for (k = 1; k <= 3; k++) printf "0 %g %slo %shi\n", edge, substr("xyz", k, 1), substr("xyz", k, 1)
        printf "\nMasses\n\n1 18.0154\n\nAtoms # atomic\n\n"
        for (k = 0; k < n; k++)
            printf "%d 1 %.4f %.4f %.4f\n", k + 1, edge / 13 * (k % 13 + 0.5), \
                edge / 13 * (int(k / 13) % 13 + 0.5), edge / 13 * (int(k / 169) + 0.5)
    }' >"$2/spce.data"
}

# What the tutorial in FROM has, with LAMMPS in place of GROMACS.
set_up_tutorial() { # METHOD FOLDER FROM TYPES MASSES [BEADS OF A MOLECULE]
    cp "$tutorials/$3/conf.gro" "$tutorials/$3"/*.tgt "$2/"
    cp "$system.in" "$2/system.in"
    awk -v types="$4" -v masses="$5" -v chain="${6:-0}" -f data.awk "$2/conf.gro" >"$2/system.data"
    awk -v method="$1" -v topology="${6:+topol.xml}" -f settings.awk "$tutorials/$3/settings.xml" >"$2/settings.xml"
}

set_up_hexane() { # METHOD FOLDER
    set_up_tutorial "$1" "$2" hexane/ibi_all "A1 A2,B" 29.062,28.054 3
    sed 's/:hex:/:HEX:/' "$tutorials/hexane/ibi_all/hexane_cg.xml" >"$2/hexane_cg.xml"
    printf '<topology base="conf.gro"><molecules><clear/>%s</molecules></topology>\n' \
        '<define name="hexane" first="1" nbeads="3" nmols="1000"/>' >"$2/topol.xml"
}

set_up_mixture() { # METHOD FOLDER
    set_up_tutorial "$1" "$2" LJ1-LJ2/imc LJ1,LJ2 39.948,20.0026
}

# Goes on after what is there.
by_votca() { # METHOD ITERATIONS
    local fit=$out/votca-$1 k last before
    local timing=$fit/timing.tsv
    mkdir -p "$fit"
    [ -e "$timing" ] || { "set_up_$system" "$1" "$fit" && printf '# iteration\tprocessor_seconds[s]\n' >"$timing"; }
    read -r last before <<<"$(awk '!/^#/ { n = $1; s = $2 } END { print n + 0, s + 0 }' "$timing")"
    read_seconds
    before=$(echo "$before $seconds" | awk '{ print $1 - $2 }')
    for k in $(seq $((last + 1)) "$2"); do
        (cd "$fit" && csg_inverse --options settings.xml --do-iterations 1 >log 2>&1)
        # What no iteration reads again.
        rm -f "$fit/step_$(printf %03d $((k - 1)))/traj.dump"
        read_seconds
        printf '%d\t%s\n' "$k" "$(echo "$seconds $before" | awk '{ print $1 + $2 }')" >>"$timing"
    done
}

by_mesofit() { # FIT RUN.JSON
    [ -e "$out/$1/summary.json" ] || "$mesofit" fit "$2" -o "$out/$1" --threads 1 || [ $? -eq 1 ]
}

case $system in
water)
    by_votca ibi "${2:-6}"
    by_votca imc "${2:-6}"
    by_mesofit mesofit-imc imc.json
    by_mesofit mesofit-ibi ibi.json
    ;;
hexane)
    by_votca ibi "${2:-9}"
    by_mesofit mesofit ../standard-set/hexane/run.json
    ;;
mixture)
    by_votca ibi "${2:-6}"
    by_votca imc "${2:-3}"
    by_mesofit mesofit ../standard-set/mixture-votca/run.json
    ;;
*)
    echo "run.sh: no system $system: water, hexane or mixture" >&2
    exit 2
    ;;
esac
bash measure.sh "$system"
