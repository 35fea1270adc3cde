#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# measure.sh: g(r) of the potentials that run.sh has left after each iteration, by one and the same Monte Carlo
# simulation without a time step: out/*/course.tsv. As a check of it, g(r) of the last but one potential of each method
# of VOTCA, and of the last one of each of mesofit, as LAMMPS and csg_stat have it: out/lammps.tsv. Then course.tsv,
# which holds all, and compare.png. MESOFIT is the program.
set -eu
export LC_ALL=C OMP_NUM_THREADS=1
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
target=../../targets/spce-votca/CG-CG.dist.tgt
beads=2180 edge=4.031

# rmse G ERRORS: over the bins of the target up to 0.9 nm, and what noise alone makes of it. G: r [nm], g, error.
rmse() {
    awk '
        FILENAME ~ /tgt/ { if ($1 <= 0.9001) target[sprintf("%.2f", $1)] = $2; next }
        /^#/ { next }
        { r = sprintf("%.2f", $1) }
        r in target { d = $2 - target[r]; s += d * d; e += $3 * $3; n++ }
        END { printf "%.5f\t%.5f", sqrt(s / n), sqrt(e / n) }' "$target" "$1"
}

# monte_carlo POTENTIAL KEYS: its g(r) in out/g.tsv.
monte_carlo() {
    cat >out/scene.json <<END
{
    "seed": 7, "units": "nm-ps", "box": [$edge, $edge, $edge], "particles": {"count": $beads, "mass": 18.015},
    "temperature": 300, "conservative": {"law": "table", "file": "$1"$2},
    "dynamics": {"integrator": "monte-carlo"}, "rdf": {"range": 1.005, "bins": 201},
    "measure": {"equilibration": 300, "samples": 300, "every": 5}
}
END
    "$mesofit" simulate out/scene.json -o out/simulation --threads 1 --quiet --force
    pairs_of_bins out/simulation/rdf.tsv >out/g.tsv
}

# Bins of 0.01 nm about 0.01, 0.02, … from the halves on either side of it.
pairs_of_bins() {
    awk '!/^#/ { k++; v = $1 * $1
        if (k % 2 == 0) { r = $1; g = $2; e = $3; w = v }
        else if (k > 1) printf "%.2f\t%.6g\t%.6g\n", (r + $1) / 2, (w * g + v * $2) / (w + v), sqrt(w * w * e * e + v * v * $3 * $3) / (w + v) }' "$1"
}

# by_lammps FIT: g(r) of a fit's potential by the engine, the script and the counting that VOTCA used, in FIT/lammps/g.tsv.
by_lammps() {
    [ ! -e "$1/lammps/g.tsv" ] || return 0
    "$mesofit" export "$1" --engine lammps -o "$1/lammps" --force >"$1/export.log" 2>&1
    cp out/votca-ibi/spce.data out/votca-ibi/settings.xml "$1/lammps/"
    sed 's/^pair_style .*/pair_style table linear 10001/; s/^pair_coeff .*/pair_coeff 1 1 mesofit.table PHI_A-A/' \
        spce.in >"$1/lammps/spce.in"
    (cd "$1/lammps" && lmp -in spce.in >lmp.log && csg_stat --nt 1 --options settings.xml --top spce.data \
        --trj traj.dump --ext g.new >stat.log && rm traj.dump)
    cp "$1/lammps/CG-CG.g.new" "$1/lammps/g.tsv"
}

# is_measured FIT: as many rows as iterations.
is_measured() {
    [ -e "$1/course.tsv" ] && [ "$(wc -l <"$1/course.tsv")" -eq "$(wc -l <"$1/timing.tsv")" ]
}

of_votca() { # METHOD
    local fit=out/votca-$1 k seconds
    ! is_measured "$fit" || return 0
    printf '# iteration\tprocessor_seconds[s]\trdf_rmse[1]\tnoise[1]\n' >"$fit/course.tsv"
    grep -v '^#' "$fit/timing.tsv" | while read -r k seconds; do
        monte_carlo "votca-$1/step_$(printf %03d "$k")/CG-CG.pot.new" ', "format": "votca"'
        printf '%d\t%s\t%s\n' "$k" "$seconds" "$(rmse out/g.tsv)" >>"$fit/course.tsv"
    done
}

of_mesofit() { # METHOD
    local fit=out/mesofit-$1 k seconds
    ! is_measured "$fit" || return 0
    printf '# iteration\tprocessor_seconds[s]\trdf_rmse[1]\tnoise[1]\n' >"$fit/course.tsv"
    grep -v '^#' "$fit/timing.tsv" | while read -r k _ seconds; do
        awk -F '\t' -v OFS='\t' -v k="$k" '
            /^#/ { for (c = 2; c <= NF; c++) { name = $c; sub(/\[.*/, "", name); if (name == k) column = c }
                   print "# r[nm]", "phi[kJ/mol]"; next }
            { print $1, $column }' "$fit/potential_history.tsv" >out/potential.tsv
        monte_carlo potential.tsv ""
        printf '%d\t%s\t%s\n' "$k" "$seconds" "$(rmse out/g.tsv)" >>"$fit/course.tsv"
    done
}

for method in ibi imc; do
    of_votca $method
    of_mesofit $method
done

# What VOTCA's own test data hold as its results, after an unknown time.
if [ ! -e out/reference.tsv ]; then
    for file in pot.ibm pot.imc; do
        monte_carlo "../../../targets/spce-votca/$file" ', "format": "votca"'
        printf '# %s\n0\tnan\t%s\n\n\n' $file "$(rmse out/g.tsv)"
    done >out/reference.part
    mv out/reference.part out/reference.tsv
fi

printf '# fit\trdf_rmse[1]\n' >out/lammps.tsv
for fit in out/votca-ibi out/votca-imc out/mesofit-imc out/mesofit-ibi; do
    case $fit in
    *votca*) set -- "$fit"/step_*; g=${!#}/CG-CG.dist.new ;;
    *) by_lammps "$fit"; g=$fit/lammps/g.tsv ;;
    esac
    printf '%s\t%s\n' "$fit" "$(rmse "$g" | cut -f 1)" >>out/lammps.tsv
done
for fit in votca-ibi votca-imc mesofit-ibi mesofit-imc; do
    printf '# %s\n' "$fit"
    cat "out/$fit/course.tsv"
    printf '\n\n'
done >course.tsv
cat out/reference.tsv >>course.tsv
cat course.tsv out/lammps.tsv
gnuplot -d figure.gp
