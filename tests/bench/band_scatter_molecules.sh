#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Whether the stated errors of bonds and angles are their scatter, and whether pressures are biased:
# independent repetitions of a fit of chains of three beads, each with a target, a fit and seeds of
# its own. Prints, for each and for all, k of the parabola through U below 4 k_B T, the deviation of
# U from the truth in units of its stated errors (rms of the bins below 2.3 k_B T, less the mean),
# and the pressure of the verification (lab/molecules.md#bands-of-bonds-and-angles).
#
# tests/bench/band_scatter_molecules.sh [PROGRAM] [FOLDER] [REPETITIONS]
# FIRST=21 picks other seeds, SAMPLES=6400 PRECISION=0.003 longer targets and finer fits. What FOLDER
# holds already is not run again.
set -eu
export LC_ALL=C.UTF-8
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:-$root/build/mesofit}")
folder=${2:-$(mktemp -d)}
repetitions=${3:-8}
first=${FIRST:-1}
numbers=$(seq "$first" $((first + repetitions - 1)))
export OMP_WAIT_POLICY=passive
mkdir -p "$folder"

scene='"box": [4.4, 4.4, 4.4], "time_step": 0.005, "molecules": {"trimer": {"count": 80, "chain":
 {"beads": ["A", "B", "A"], "bond": "backbone", "angle": "bend"}}},
 "dissipative": {"law": "power", "sigma": 3}'
laws='"bonds": {"backbone": {"law": "harmonic", "k": 100, "length": 0.6}},
 "angles": {"bend": {"law": "harmonic", "k": 12, "angle": 110}},
 "conservative": {"A-A": {"law": "soft-repulsion", "a": 20},
 "A-B": {"law": "soft-repulsion", "a": 12}, "B-B": {"law": "soft-repulsion", "a": 25}}'

# $1: the seed of the fit; the target has another.
repeat() {
    target=$folder/target-$1
    if [ ! -e "$target/summary.json" ]; then
        cat >"$target.json" <<EOF_TARGET
{"title": "target $1", "seed": $((100 + $1)), $scene, $laws,
 "rdf": {"range": 1.2, "bins": 30}, "bond_lengths": {"bins": 50}, "bond_angles": {"bins": 36},
 "measure": {"equilibration": 2000, "samples": ${SAMPLES:-1600}, "every": 25}}
EOF_TARGET
        "$program" simulate "$target.json" -o "$target" --quiet --threads 2
    fi
    out=$folder/imc-$1
    [ -e "$out/summary.json" ] && return
    cat >"$out.json" <<EOF_FIT
{"title": "fit $1", "seed": $1, "target": {"rdf": {"A-A": {"file": "$target/rdf_A-A.tsv"},
  "A-B": {"file": "$target/rdf_A-B.tsv"}, "B-B": {"file": "$target/rdf_B-B.tsv"}},
  "bond_lengths": {"backbone": {"file": "$target/bond_lengths.tsv"}},
  "bond_angles": {"bend": {"file": "$target/bond_angles.tsv"}}},
 "scene": {$scene},
 "method": {"name": "imc", "replicas": 4, "precision": ${PRECISION:-0.006}},
 "verification": {"replicas": 2, "equilibration": 1000, "samples": 400, "every": 25}}
EOF_FIT
    "$program" fit "$out.json" -o "$out" --quiet --force --threads 2 2>"$out.errors" ||
        echo "repetition $1: $(head -1 "$out.errors")"
}

# Of a table of U: k and the deviation. $2: name, $3: unit of q, $4 and $5: k and rest of the truth.
judge() {
    awk -v name="$2" -v unit="$3" -v k="$4" -v rest="$5" '
        !/^#/ && $3 > 0 {
            q = unit * $1; u = k / 2 * (q - rest) ^ 2; x = q - rest
            p = exp(-u) * (name == "bonds" ? q * q : sin(q))
            off[n] = $2 - u; error[n] = $3; close_by[n++] = u < 2.3
            mean += p * ($2 - u); sum += p
            if (u < 4)
                for (i = 0; i < 3; i++) {
                    right[i] += exp(-u) * x ^ i * $2
                    for (j = 0; j < 3; j++)
                        left[i, j] += exp(-u) * x ^ (i + j)
                }
        }
        END {
            for (i = 0; i < 3; i++)
                for (j = 0; j < 3; j++)
                    if (j != i) {
                        part = left[j, i] / left[i, i]
                        for (m = 0; m < 3; m++)
                            left[j, m] -= part * left[i, m]
                        right[j] -= part * right[i]
                    }
            for (m = 0; m < n; m++)
                if (close_by[m]) {
                    squares += ((off[m] - mean / sum) / error[m]) ^ 2
                    bins++
                }
            printf "%.8g %.8g ", 2 * right[2] / left[2, 2], sqrt(squares / bins)
        }' "$1"
}

for n in $numbers; do
    repeat "$n"
    out=$folder/imc-$n
    printf '%s ' "$n"
    judge "$out/bonds_backbone.tsv" bonds 1 100 0.6
    judge "$out/angles_bend.tsv" angles 0.017453292519943295 12 1.9198621771937625
    awk -F '[:,]' '/"pressure"/ { printf "%.8g ", $2 }' "$out/summary.json"
    awk '!/^#/ { last = $1 } END { print last + 1 }' "$out/history.tsv"
done | awk '
    {
        printf "%d: %d iterations, k of bonds %.2f, of angles %.3f, off by %.2f and %.2f " \
            "stated errors, pressure %.3f\n", $1, $7, $2, $4, $3, $5, $6
        for (c = 2; c <= 7; c++) {
            sum[c] += $c; squares[c] += $c * $c
        }
    }
    function scatter(c) { return sqrt((squares[c] / NR - (sum[c] / NR) ^ 2) / (NR - 1)) }
    END {
        if (NR < 2)
            exit
        printf "all: %.1f iterations, k of bonds %.2f(%.2f) of 100, of angles %.3f(%.3f) of 12, " \
            "off by %.2f and %.2f stated errors (rms), pressure %.3f(%.3f) of 12.024\n",
            sum[7] / NR, sum[2] / NR, scatter(2), sum[4] / NR, scatter(4), sqrt(squares[3] / NR),
            sqrt(squares[5] / NR), sum[6] / NR, scatter(6)
    }'
