#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh [ITERATIONS]: SPC/E water, VOTCA's own target, by VOTCA (csg_inverse of Debian's package votca, its
# tutorial's settings, LAMMPS as its engine) and by mesofit, each on one thread: out/votca-ibi, out/votca-imc,
# out/mesofit-imc, out/mesofit-ibi. Then measure.sh. MESOFIT is the program; it goes on after what is there.
set -eu
export LC_ALL=C OMP_NUM_THREADS=1
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit} iterations=${1:-6}
mkdir -p out

# Puts the processor seconds of all children so far into $seconds; in a subshell there would be none.
read_seconds() {
    times >"out/times.$$"
    seconds=$(awk -F '[ms ]' 'NR == 2 { print 60 * $1 + $2 + 60 * $4 + $5 }' "out/times.$$")
}

set_up() { # METHOD
    mkdir -p "out/votca-$1"
    cp spce.in ../../targets/spce-votca/CG-CG.dist.tgt "out/votca-$1/"
    post=
    [ "$1" = ibi ] || post='<post_update>smooth</post_update><post_update_options><smooth><iterations>2</iterations></smooth></post_update_options>'
    sed "s|METHOD|$1|; s|POST|$post|" settings.xml >"out/votca-$1/settings.xml"
    # A simple cubic lattice of 13³ sites, 17 of them empty; [Å].
    awk 'BEGIN {
        n = 2180; edge = 40.31
        printf "Beads on a lattice\n\n%d atoms\n1 atom types\n\n", n
        for (k = 1; k <= 3; k++) printf "0 %g %slo %shi\n", edge, substr("xyz", k, 1), substr("xyz", k, 1)
        printf "\nMasses\n\n1 18.0154\n\nAtoms # atomic\n\n"
        for (k = 0; k < n; k++)
            printf "%d 1 %.4f %.4f %.4f\n", k + 1, edge / 13 * (k % 13 + 0.5), \
                edge / 13 * (int(k / 13) % 13 + 0.5), edge / 13 * (int(k / 169) + 0.5)
    }' >"out/votca-$1/spce.data"
}

# Goes on after what is there.
votca() { # METHOD
    local timing=out/votca-$1/timing.tsv k last before
    [ -e "$timing" ] || { set_up "$1" && printf '# iteration\tprocessor_seconds[s]\n' >"$timing"; }
    read -r last before <<<"$(awk '!/^#/ { n = $1; s = $2 } END { print n + 0, s + 0 }' "$timing")"
    read_seconds
    before=$(echo "$before $seconds" | awk '{ print $1 - $2 }')
    for k in $(seq $((last + 1)) "$iterations"); do
        (cd "out/votca-$1" && csg_inverse --options settings.xml --do-iterations 1 >log 2>&1)
        # What no iteration reads again.
        rm -f "out/votca-$1/step_$(printf %03d $((k - 1)))/traj.dump"
        read_seconds
        printf '%d\t%s\n' "$k" "$(echo "$seconds $before" | awk '{ print $1 + $2 }')" >>"$timing"
    done
}

votca ibi
votca imc
for method in imc ibi; do
    [ -e "out/mesofit-$method/summary.json" ] ||
        "$mesofit" fit "$method.json" -o "out/mesofit-$method" --threads 1 || [ $? -eq 1 ]
done
bash measure.sh
