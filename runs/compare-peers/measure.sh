#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# measure.sh [SYSTEM]: g(r), and of molecules bonds and angles, of the potentials that run.sh has left after each
# iteration, by one and the same Monte Carlo simulation without a time step: out/SYSTEM/*/course.tsv. As a check of it,
# g(r) as LAMMPS and csg_stat have it, of the last but one potential of each method of VOTCA, and of water of the last one
# of each of mesofit: out/SYSTEM/lammps.tsv. Then SYSTEM.tsv, which holds all, and its figure. MESOFIT is the program.
set -eu -o pipefail
export LC_ALL=C OMP_NUM_THREADS=1
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit} system=${1:-water}
out=out/$system tables=out/$system/tables simulation=out/$system/simulation
mkdir -p "$tables"

# The targets, up to which r [nm] g(r) is compared, what it tends to as mesofit tells, if not to 1, and the scene, with the
# potentials in $tables.
bonds='' angles='' tail=''
case $system in
water)
    targets=../../targets/spce-votca pairs=CG-CG range=0.9 fits='votca-ibi votca-imc mesofit-ibi mesofit-imc'
    scene='"box": [4.031, 4.031, 4.031], "particles": {"count": 2180, "mass": 18.015}, "temperature": 300,
    "conservative": {"law": "table", "file": "CG-CG.tsv"},
    "rdf": {"range": 1.005, "bins": 201}, "measure": {"equilibration": 300, "samples": 300, "every": 5}'
    ;;
hexane)
    targets=../standard-set/hexane pairs='A-A A-B B-B' bonds=bond angles=angle range=1.35 fits='votca-ibi mesofit'
    scene='"box": [6.04233, 6.04233, 6.04233], "temperature": 300,
    "particles": {"mass": {"A": 29.062, "B": 28.054}, "placement": "file", "file": "../votca-ibi/conf.gro"},
    "molecules": {"hexane": {"count": 1000, "chain": {"beads": ["A", "B", "A"], "bond": "bond", "angle": "angle"}}},
    "bonds": {"bond": {"law": "table", "file": "bond.tsv"}}, "angles": {"angle": {"law": "table", "file": "angle.tsv"}},
    "conservative": {"A-A": {"law": "table", "file": "A-A.tsv"}, "A-B": {"law": "table", "file": "A-B.tsv"},
        "B-B": {"law": "table", "file": "B-B.tsv"}},
    "rdf": {"range": 1.355, "bins": 271}, "bond_lengths": {"bins": 20000}, "bond_angles": {"bins": 20000},
    "measure": {"equilibration": 200, "samples": 300, "every": 2}'
    ;;
mixture)
    targets=../standard-set/mixture-votca pairs='LJ1-LJ1 LJ1-LJ2 LJ2-LJ2' range=0.85 tail=0.9917
    fits='votca-ibi votca-imc mesofit'
    scene='"box": [4.30484, 4.30484, 4.30484], "temperature": 85,
    "particles": {"types": {"LJ1": 1000, "LJ2": 1000}, "mass": {"LJ1": 39.948, "LJ2": 20.0026}},
    "conservative": {"LJ1-LJ1": {"law": "table", "file": "LJ1-LJ1.tsv"}, "LJ1-LJ2": {"law": "table", "file": "LJ1-LJ2.tsv"},
        "LJ2-LJ2": {"law": "table", "file": "LJ2-LJ2.tsv"}},
    "rdf": {"range": 0.855, "bins": 171}, "measure": {"equilibration": 300, "samples": 300, "every": 5}'
    ;;
*)
    echo "measure.sh: no system $system: water, hexane or mixture" >&2
    exit 2
    ;;
esac

# of_pair PAIR: what mesofit adds to the names of its files; nothing where there is one type.
of_pair() {
    [ "$pairs" = "$1" ] || echo "_$1"
}

# in_bins WIDTH [POWER] [SCALE]: of rows x, value, error, with x multiplied by SCALE and weighed by x^POWER, means in bins
# of WIDTH about its multiples: number of the bin, mean, its error.
in_bins() {
    awk -v width="$1" -v power="${2:-0}" -v scale="${3:-1}" '
        !/^[#@]/ { k = int($1 * scale / width + 0.5); w = $1 ^ power; n[k] += w; s[k] += w * $2; e[k] += (w * $3) ^ 2 }
        END { for (k in n) if (n[k] > 0) printf "%d\t%.8g\t%.8g\n", k, s[k] / n[k], sqrt(e[k]) / n[k] }' | sort -k 1,1
}

# rmse FILE [TAIL]: of g - g*/TAIL over the bins of 0.01 nm of all pairs, from the first where the target is above 0 up to
# the range, and what noise alone makes of it. FILE holds r [nm], g, error; PAIR in its name stands for each pair, _PAIR as
# mesofit has it.
rmse() {
    local pair file
    for pair in $pairs; do
        file=${1/_PAIR/$(of_pair "$pair")}
        join -t $'\t' <(in_bins 0.01 2 <"$targets/$pair.dist.tgt") <(in_bins 0.01 2 <"${file/PAIR/$pair}") | sort -n |
            awk -v last="$range" '$2 > 0 { begun = 1 } begun && $1 <= 100 * last + 0.5'
    done | awk -v tail="${2:-1}" '
        { d = $4 - $2 / tail; s += d * d; e += $5 * $5; n++ }
        END { printf "%.5f\t%.5f", sqrt(s / n), sqrt(e / n) }'
}

# misplaced TARGET RESULT WIDTH [SCALE]: half the integral of |p - p*|, the share of the bonds or angles that are not where
# the target has them, and what noise alone makes of it. WIDTH: the target's bins, its x multiplied by SCALE.
misplaced() {
    join -t $'\t' -a 1 -a 2 -e 0 -o 1.2,2.2,2.3 <(in_bins "$3" 0 "${4:-1}" <"$1") <(in_bins "$3" <"$2") |
        awk '{ target[NR] = $1; p[NR] = $2; e[NR] = $3; all_target += $1; all += $2 }
            END {
                for (k in p) { d = p[k] / all - target[k] / all_target; s += d < 0 ? -d : d; noise += 0.798 * e[k] / all }
                printf "\t%.5f\t%.5f", s / 2, noise / 2
            }'
}

# The scene with the potentials in $tables: errors, each with its noise, of g(r), and of bonds and angles if there are any.
errors() {
    printf '{\n    "seed": 7, "units": "nm-ps", "dynamics": {"integrator": "monte-carlo"},\n    %s\n}\n' \
        "$scene" >"$tables/scene.json"
    "$mesofit" simulate "$tables/scene.json" -o "$simulation" --threads 1 --quiet --force
    rmse "$simulation/rdf_PAIR.tsv"
    [ -z "$tail" ] || printf '\t%s' "$(rmse "$simulation/rdf_PAIR.tsv" "$tail")"
    [ -z "$bonds" ] || misplaced "$targets/$bonds.dist.tgt" "$simulation/bond_lengths.tsv" 0.001
    # Its bins are of π/314.
    [ -z "$angles" ] || misplaced "$targets/$angles.dist.tgt" "$simulation/bond_angles.tsv" 0.573248 57.29578
}

# The potentials after iteration K to $tables, in nm, degrees and kJ/mol.

# As LAMMPS had them, with VOTCA's own continuation beyond both ends: of bonds and angles it matters.
potentials_of_votca() { # FIT K
    local name
    for name in $pairs; do by_csg_call "$1" "$2" "$name" non-bonded 0.1; done
    for name in $bonds; do by_csg_call "$1" "$2" "$name" bond 0.1; done
    for name in $angles; do by_csg_call "$1" "$2" "$name" angle 1; done
}

by_csg_call() { # FIT K NAME TYPE SCALE
    (cd "$out/$1" && csg_call --options settings.xml --ia-type "$4" --ia-name "$3" convert_potential lammps --clean \
        "step_$(printf %03d "$2")/$3.pot.new" table >csg_call.log 2>&1)
    awk -v scale="$5" 'NF == 4 { print $2 * scale "\t" $3 / 0.239006 }' "$out/$1/table" >"$tables/$3.tsv"
}

potentials_of_mesofit() { # FIT K
    local name column=$(($2 + 2))
    for name in $pairs; do columns "$out/$1/potential$(of_pair "$name")_history.tsv" $column "$name"; done
    for name in $bonds; do columns "$out/$1/bonds_${name}_history.tsv" $column "$name"; done
    for name in $angles; do columns "$out/$1/angles_${name}_history.tsv" $column "$name"; done
}

columns() { # FILE COLUMN NAME
    awk -v column="$2" '!/^#/ { print $1 "\t" $column }' "$1" >"$tables/$3.tsv"
}

# course FIT: unless it is there, with as many rows as iterations.
course() {
    local fit=$out/$1 k seconds
    [ ! -e "$fit/course.tsv" ] || [ "$(wc -l <"$fit/course.tsv")" -ne "$(wc -l <"$fit/timing.tsv")" ] || return 0
    {
        printf '# iteration\tprocessor_seconds[s]\trdf_rmse[1]\tnoise[1]'
        [ -z "$tail" ] || printf '\trdf_rmse_by_tail[1]\tnoise[1]'
        [ -z "$bonds" ] || printf '\tbonds_misplaced[1]\tnoise[1]'
        [ -z "$angles" ] || printf '\tangles_misplaced[1]\tnoise[1]'
        # Of mesofit the time of the clock stands before that of the processor.
        awk '!/^#/ { print $1, (NF > 2 ? $3 : $2) }' "$fit/timing.tsv" | while read -r k seconds; do
            "potentials_of_${1%%-*}" "$1" "$k"
            printf '\n%d\t%s\t%s' "$k" "$seconds" "$(errors)"
        done
        printf '\n'
    } >"$fit/course.part"
    mv "$fit/course.part" "$fit/course.tsv"
}

# by_lammps FIT: g(r) of a fit's potential of water by the engine, the script and the counting that VOTCA used.
by_lammps() {
    local fit=$out/$1
    [ ! -e "$fit/lammps/CG-CG.g.new" ] || return 0
    "$mesofit" export "$fit" --engine lammps -o "$fit/lammps" --force >"$fit/export.log" 2>&1
    cp "$out/votca-ibi/spce.data" "$out/votca-ibi/settings.xml" "$fit/lammps/"
    sed 's/^pair_style .*/pair_style table linear 10001/; s/^pair_coeff .*/pair_coeff 1 1 mesofit.table PHI_A-A/' \
        spce.in >"$fit/lammps/spce.in"
    (cd "$fit/lammps" && lmp -in spce.in >lmp.log && csg_stat --nt 1 --options settings.xml --top spce.data \
        --trj traj.dump --ext g.new >stat.log && rm traj.dump)
}

for fit in $fits; do course "$fit"; done

# What VOTCA's own test data hold as its results for water, after an unknown time.
if [ "$system" = water ] && [ ! -e "$out/reference.tsv" ]; then
    for file in pot.ibm pot.imc; do
        columns "$targets/$file" 2 CG-CG
        printf '# %s\n0\tnan\t%s\n\n\n' $file "$(errors)"
    done >"$out/reference.part"
    mv "$out/reference.part" "$out/reference.tsv"
fi

printf '# fit\trdf_rmse[1]\n' >"$out/lammps.tsv"
for fit in $fits; do
    case $fit in
    votca-*) set -- "$out/$fit"/step_*; g=${!#}/PAIR.dist.new ;;
    *) [ "$system" = water ] || continue; by_lammps "$fit"; g=$out/$fit/lammps/PAIR.g.new ;;
    esac
    printf '%s\t%s\n' "$fit" "$(rmse "$g" | cut -f 1)" >>"$out/lammps.tsv"
done
for fit in $fits; do
    printf '# %s\n' "$fit"
    cat "$out/$fit/course.tsv"
    printf '\n\n'
done >"$system.tsv"
[ "$system" != water ] || cat "$out/reference.tsv" >>"$system.tsv"
cat "$system.tsv" "$out/lammps.tsv"
gnuplot -d figure.gp
