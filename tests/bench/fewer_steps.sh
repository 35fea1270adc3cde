#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# How many engine steps racing, warm starts and stopping by precision save a fit: the same fits with
# and without them, to the same verified error. Writes tests/bench/results/fewer-steps.tsv.
#
# tests/bench/fewer_steps.sh [PROGRAM] [FOLDER]
# SEEDS="1 2" picks seeds. Fits that FOLDER holds already are not run again.
set -eu
export LC_ALL=C.UTF-8
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:-$root/build/mesofit}")
folder=${2:-$(mktemp -d)}
seeds=${SEEDS:-1 2 3 4 5}
water=$root/targets/spc-water
export OMP_WAIT_POLICY=passive
mkdir -p "$folder"

scene='"box": [5.3874, 5.3874, 5.3874], "particles": {"count": 512}, "temperature": 1'

# What a candidate's simulation is: $1 plan, $2 problem, which says how long one may be.
plan() {
    fast='"equilibration": 50, "warm_start": "yes"'
    slow='"equilibration": 350'
    precise='"precision": 0.1'
    [ "$2" = potential ] || precise='"precision": 0.2'
    race='"racing": 2'
    case $1 in
    plain) echo "$slow" ;;
    warm) echo "$fast" ;;
    precision) echo "$slow, $precise" ;;
    racing) echo "$slow, $race" ;;
    all) if [ "$2" = potential ]; then echo "$fast, $precise"; else echo "$fast, $precise, $race"; fi ;;
    esac
}

# $1 plan: Phi(r) from g(r) by Gauss-Newton steps, which has no use for racing.
potential() {
    cat <<EOF
{"title": "fewer steps", "seed": 1,
 "target": {"rdf": {"file": "$water/spc298_rdf_com_1.0nm_100.txt", "r_column": 4, "g_column": 5,
                    "error_column": 6, "particles": 2744}},
 "unknowns": {"potential": {"curve": "bspline", "coefficients": 20, "minimum": -6, "maximum": 6}},
 "scene": {$scene, "time_step": 0.008,
  "dissipative": {"law": "power", "sigma": 2.589, "inner_cutoff": 0.596, "cutoff": 1.72}},
 "method": {"name": "gauss-newton", "iterations": 8, "reach": 0.03, "samples": 30, "every": 20,
            "temperature_tolerance": 0.15, $(plan "$1" potential)},
 "verification": {"replicas": 2, "time_step": 0.004, "equilibration": 1000, "samples": 60,
                  "every": 50}}
EOF
}

# $1 plan: omega(r) from escape times by CMA-ES.
omega() {
    cat <<EOF
{"title": "fewer steps", "seed": 1,
 "target": {"etd": {"file": "$water/spc298_etd_E.txt", "error_file": "$water/spc298_etd_se.txt",
  "time_column": 2, "first_column": 3, "r_minimum": 0.5376344, "r_maximum": 1.0752688}},
 "unknowns": {"omega": {"curve": "bspline", "coefficients": 8, "minimum": 0, "maximum": 10,
                         "cutoff": 1.72}},
 "scene": {$scene, "time_step": 0.007974745,
  "conservative": {"law": "table", "file": "$water/potential_imc.tsv",
                   "cutoff": 2.1505373737373734}},
 "method": {"name": "cma-es", "population": 10, "rounds": 12, "step": 0.15, "samples": 60,
            "every": 20, "temperature_tolerance": 0.3, $(plan "$1" omega)},
 "verification": {"replicas": 2, "time_step": 0.0039873725, "equilibration": 500, "samples": 75,
                  "every": 40}}
EOF
}

# $1 problem, $2 plan, $3 seed
fit() {
    here=$folder/$1-$2-$3
    [ -e "$here/summary.json" ] && return
    mkdir -p "$here"
    "$1" "$2" >"$here/run.json"
    "$program" fit "$here/run.json" -o "$here" --seed "$3" --quiet --force --threads "${THREADS:-2}" ||
        echo "$here: did not end well" >&2
}

value() {
    sed -n "s/^[[:space:]]*\"$2\":[[:space:]]*\([^,]*\),*/\1/p" "$1/summary.json"
}

for seed in $seeds; do
    for problem in potential omega; do
        fit $problem all "$seed"
        fit $problem plain "$seed"
        [ "$seed" = 1 ] || continue
        fit $problem warm 1
        fit $problem precision 1
        [ $problem = potential ] || fit $problem racing 1
    done
done

table=$root/tests/bench/results/fewer-steps.tsv
{
    printf '# problem\tplan\tseed\tevaluations\tengine_steps\terror[1]\terror_error[1]\n'
    for here in "$folder"/*-*-*/; do
        [ -e "$here/summary.json" ] || continue
        name=$(basename "$here")
        case $name in potential*) key=rdf ;; *) key=etd ;; esac
        printf '%s\t%s\t%s\t%s\t%s\n' "$(echo "$name" | tr - '\t')" \
            "$(value "$here" evaluations)" "$(value "$here" engine_steps)" \
            "$(value "$here" ${key}_rmse)" "$(value "$here" ${key}_rmse_error)"
    done
} >"$table"
awk -F '\t' '!/^#/ { k = $1 " " $2; n[k]++; s[k] += $5; e[k] += $6; q[k] += $6 * $6 }
    END { for (k in n) { m = e[k] / n[k]; v = n[k] > 1 ? (q[k] / n[k] - m * m) / (n[k] - 1) : 0
          printf "%-20s %d seeds: %7.0f steps, error %.4f(%.4f)\n", k, n[k], s[k] / n[k], m,
                 sqrt(v > 0 ? v : 0) } }' "$table" | sort
