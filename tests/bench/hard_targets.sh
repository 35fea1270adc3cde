#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Targets that make an inversion difficult, of Lennard-Jones fluids, so that the truth is known:
# noise, coarse and fine bins, a gap, a hole, a dense fluid and a gas. Prints how each fit ends and
# how far it is from the truth (lab/hard-targets.md).
#
# tests/bench/hard_targets.sh [PROGRAM] [FOLDER]
# METHODS="imc auto" picks methods. What FOLDER holds already is not run again.
set -eu
export LC_ALL=C.UTF-8
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:-$root/build/mesofit}")
folder=${2:-$(mktemp -d)}
methods=${METHODS:-auto imc hnc ibi}
export OMP_WAIT_POLICY=passive
mkdir -p "$folder"

# $1 particles, $2 edge.
scene() {
    cat <<EOF_SCENE
"box": [$2, $2, $2], "particles": {"count": $1}, "temperature": 1, "time_step": 0.004,
 "dissipative": {"law": "power", "sigma": 2.1213203435596424, "cutoff": 1.5}
EOF_SCENE
}

law='{"law": "lennard-jones", "epsilon": 1, "sigma": 1, "cutoff": 2.5}'

# $1 name, $2 particles, $3 edge, $4 bins: measure a target.
measure() {
    [ -e "$folder/$1/rdf.tsv" ] && return
    cat >"$folder/$1-source.json" <<EOF_SOURCE
{"title": "$1", "seed": 7, $(scene "$2" "$3"), "conservative": $law,
 "measure": {"equilibration": 10000, "samples": 2000, "every": 20},
 "rdf": {"range": 2.5, "bins": $4}}
EOF_SOURCE
    "$program" simulate "$folder/$1-source.json" -o "$folder/$1" --quiet --threads 2
}

# $1 name, $2 particles, $3 edge, $4 target, $5 method, $6 steps before the verification counts:
# fit, and one row of the table.
fit() {
    out=$folder/fit-$1-$5
    if [ ! -e "$out.errors" ]; then
        cat >"$out.json" <<EOF_FIT
{"title": "$1", "seed": 1, "target": {"rdf": {"file": "$4"}}, "scene": {$(scene "$2" "$3")},
 "unknowns": {"potential": {"truth": $law}}, "method": {"name": "$5", "particles": 500},
 "verification": {"replicas": 2, "equilibration": $6, "samples": 100, "every": 25}}
EOF_FIT
        "$program" fit "$out.json" -o "$out" --quiet --force --threads 2 2>"$out.errors" || true
    fi
    message=$(head -1 "$out.errors" | sed "s|$folder/||g; s/^mesofit: //")
    [ -e "$out/summary.json" ] || { echo "$1 | $5 | refused | | | | | | $message"; return; }
    awk -v name="$1" -v method="$5" -v message="$message" '
        function rounded(key) { return key in value ? sprintf("%.4f", value[key]) : "-" }
        { gsub(/[",]/, ""); key = $1; sub(/:$/, "", key); $1 = ""; sub(/^ /, ""); value[key] = $0 }
        END {
            printf "%s | %s | %s | %s | %s(%s) | %s | %s | %s | %s\n", name, method,
                value["status"], value["iterations"], rounded("rdf_rmse"),
                rounded("rdf_rmse_error"), rounded("rdf_noise"), rounded("truth_rms"),
                rounded("truth_rms_without_ramp"), message
        }' "$out/summary.json"
}

measure plain 1382 12 125
measure bins-30 1382 12 30
measure bins-400 1382 12 400
measure dense 1372 11.304 125
measure gas 1000 27.144 125

# Normal noise of 1 % of g, by Box and Muller with a fixed seed, and the error to match.
awk 'BEGIN { srand(1) } /^#/ { print; next }
     { noise = sqrt(-2 * log(1 - rand())) * cos(6.283185307 * rand())
       g = $2 * (1 + 0.01 * noise); print $1, g, sqrt($3 * $3 + 0.0001 * g * g) }' \
    "$folder/plain/rdf.tsv" >"$folder/noise.tsv"
# Rows left out, and rows that say that no pair is there.
awk '/^#/ || $1 < 1.4 || $1 > 1.5' "$folder/plain/rdf.tsv" >"$folder/gap.tsv"
awk '/^#/ || $1 < 1.4 || $1 > 1.5 { print; next } { print $1, 0, 0 }' "$folder/plain/rdf.tsv" \
    >"$folder/hole.tsv"

echo "target | method | ends | iterations | rdf_rmse | statistics | truth_rms | without ramp |"
for method in $methods; do
    fit plain 1382 12 "$folder/plain/rdf.tsv" "$method" 2000
    fit noise 1382 12 "$folder/noise.tsv" "$method" 2000
    fit bins-30 1382 12 "$folder/bins-30/rdf.tsv" "$method" 2000
    fit bins-400 1382 12 "$folder/bins-400/rdf.tsv" "$method" 2000
    fit gap 1382 12 "$folder/gap.tsv" "$method" 2000
    fit hole 1382 12 "$folder/hole.tsv" "$method" 2000
    fit dense 1372 11.304 "$folder/dense/rdf.tsv" "$method" 2000
    # Pairs of a gas meet rarely: with 2000 steps g was off by 0.05 of 0.02 by statistics.
    fit gas 1000 27.144 "$folder/gas/rdf.tsv" "$method" 40000
done
