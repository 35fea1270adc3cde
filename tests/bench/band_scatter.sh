#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Whether the stated errors of a potential are its scatter: independent repetitions of an inversion
# of Lennard-Jones, each with a target, a fit and seeds of its own. Prints, over the bins with
# g > 0.1, the scatter and the deviation from the truth in units of the stated standard errors,
# as they are and without the best ramp A (1 − r/r_c) of each (lab/hard-targets.md).
#
# tests/bench/band_scatter.sh [PROGRAM] [FOLDER] [REPETITIONS]
# METHOD=hnc picks another method, FIRST=21 other seeds. What FOLDER holds already is not run again.
set -eu
export LC_ALL=C.UTF-8
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:-$root/build/mesofit}")
folder=${2:-$(mktemp -d)}
repetitions=${3:-20}
method=${METHOD:-imc}
first=${FIRST:-1}
numbers=$(seq "$first" $((first + repetitions - 1)))
export OMP_WAIT_POLICY=passive
mkdir -p "$folder"

scene='"box": [8.55, 8.55, 8.55], "particles": {"count": 500}, "temperature": 1,
 "time_step": 0.004, "dissipative": {"law": "power", "sigma": 2.1213203435596424, "cutoff": 1.5}'
law='{"law": "lennard-jones", "epsilon": 1, "sigma": 1, "cutoff": 2.5}'

# $1: the seed of the target; the fit has another.
repeat() {
    if [ ! -e "$folder/target-$1/rdf.tsv" ]; then
        cat >"$folder/target-$1.json" <<EOF_TARGET
{"title": "target $1", "seed": $((1000 + $1)), $scene, "conservative": $law,
 "measure": {"equilibration": 5000, "samples": 4000, "every": 20},
 "rdf": {"range": 2.5, "bins": 60}}
EOF_TARGET
        "$program" simulate "$folder/target-$1.json" -o "$folder/target-$1" --quiet --threads 2
    fi
    out=$folder/$method-$1
    [ -e "$out/summary.json" ] && return
    cat >"$out.json" <<EOF_FIT
{"title": "fit $1", "seed": $1, "target": {"rdf": {"file": "$folder/target-$1/rdf.tsv"}},
 "scene": {$scene}, "unknowns": {"potential": {"truth": $law}}, "method": {"name": "$method"},
 "verification": {"replicas": 1, "equilibration": 100, "samples": 10, "every": 25}}
EOF_FIT
    "$program" fit "$out.json" -o "$out" --quiet --force --threads 2 2>"$out.errors" ||
        echo "repetition $1: $(head -1 "$out.errors")"
}

# g of the target, then Φ, its error, that without the ramp, and the truth: one row a bin.
rows() {
    for n in $numbers; do
        paste "$folder/$method-$n/rdf.tsv" "$folder/$method-$n/potential.tsv" |
            awk -v n="$n" '!/^#/ && $2 > 0.1 { print n, $1, $7, $9, $10, $11 }'
    done
}

for n in $numbers; do
    repeat "$n"
done
rows | awk '
    function add(kind, r, off, error) {
        key = kind " " r
        sum[key] += off; squares[key] += off * off; variance[key] += error * error; count[key]++
        one[kind] += off * off < error * error
        two[kind] += off * off < 4 * error * error
        chi[kind] += off * off / (error * error)
        all[kind]++
    }
    {
        n[NR] = $1; r[NR] = $2; off[NR] = $3 - $6; error[NR] = $4; without[NR] = $5
        ramp = 1 - $2 / 2.5
        above[$1] += ramp * off[NR]; below[$1] += ramp * ramp
    }
    END {
        for (k = 1; k <= NR; k++) {
            add("with", r[k], off[k], error[k])
            add("without", r[k], off[k] - above[n[k]] / below[n[k]] * (1 - r[k] / 2.5), without[k])
        }
        for (key in sum) {
            split(key, part, " ")
            mean = sum[key] / count[key]
            scatter = (squares[key] - count[key] * mean * mean) / (count[key] - 1)
            kind = part[1]
            ratio[kind] += scatter / (variance[key] / count[key]); bins[kind]++
            spread[kind] += scatter; bias[kind] += mean * mean
        }
        for (kind in ratio)
            printf "%-7s the ramp: scatter %.4f, bias %.4f, scatter over stated error, rms of " \
                "%d bins, %.2f; off the truth by %.2f stated errors (rms), within 1 %.0f %%, " \
                "2 %.0f %%\n", kind, sqrt(spread[kind] / bins[kind]),
                sqrt(bias[kind] / bins[kind]), bins[kind], sqrt(ratio[kind] / bins[kind]),
                sqrt(chi[kind] / all[kind]), 100 * one[kind] / all[kind],
                100 * two[kind] / all[kind]
    }'
