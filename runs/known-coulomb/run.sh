#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: the target by a simulation of the truth (out/truth), the fit (out/fit), and README.md of both.
# MESOFIT is the program.
set -eu
export LC_ALL=C
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
mkdir -p out
"$mesofit" simulate truth.json -o out/truth --force
cp out/truth/rdf_A-A.tsv out/truth/rdf_A-B.tsv out/truth/rdf_B-B.tsv .
"$mesofit" fit run.json -o out/fit --force

# NAME of a summary, with so many digits.
number() { # FILE NAME FORMAT
    awk -F '[:,]' -v name="\"$2\"" -v format="$3" 'index($1, name) { printf format, $2; exit }' "$1"
}

# rms of Φ - truth over its error, where it has one.
in_errors() { # PAIR
    awk '/^#/ { for (k = 2; k <= NF; k++) { split($k, name, "["); at[name[1]] = k - 1 } next }
         $at["phi_error"] != "nan" { sum += (($at["phi"] - $at["truth"]) / $at["phi_error"])^2; n++ }
         END { printf "%.1f", sqrt(sum / n) }' "out/fit/potential_$1.tsv"
}

row() { # WORDS NAME FORMAT
    echo "| $1 | $(number out/fit/summary.json "$2_A-A" "$3") | $(number out/fit/summary.json "$2_A-B" "$3") | $(number out/fit/summary.json "$2_B-B" "$3") |"
}

cat >README.md <<END
# Screened charges are known, the rest is found

A mixture of 200 beads A and 200 B in (10 λ)³ that repel each other by Weeks, Chandler and Andersen's law, and by ±4 exp(−r/0.8)/r k_B T up to 3 λ, as charges that are screened: like ones repel, unlike ones attract. Its g(r) up to 2.4 λ is the target (\`truth.json\`). The charges are [\`"known"\`](../../docs/fit.md#a-part-that-is-known), and the fit finds what is left.

    sh runs/known-coulomb/run.sh    # simulation, fit and this page
    mesofit fit runs/known-coulomb/run.json

| | A-A | A-B | B-B |
|---|---|---|---|
$(row "Φ − truth, rms [k_B T]" truth_rms %.3f)
| the same in stated errors | $(in_errors A-A) | $(in_errors A-B) | $(in_errors B-B) |

Converged after $(number out/fit/summary.json iterations %d) iterations; rms of g − g* = $(number out/fit/summary.json rdf_rmse %.4f). The pressure, which is of both parts, is $(number out/fit/summary.json pressure %.3f), that of the truth $(number out/truth/summary.json pressure %.3f). The start, the hypernetted chain's potential less the known part, had an error of g of $(awk -F '\t' '!/^#/ { printf "%.3f", $4; exit }' out/fit/history.tsv).
END
