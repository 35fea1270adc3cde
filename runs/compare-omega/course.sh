#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# course.sh FIT: how far from the target E(t, r_0) was with water's friction as a fit's folder holds it after each of
# some iterations, by an independent simulation of it with half the time step of the fit: FIT/course.tsv. Of a folder
# without a fit, the linear friction of the thesis. MESOFIT is the program.
set -eu
mesofit=${MESOFIT:-mesofit}
fit=$1
seed=${fit##*-}
here=$(cd "$(dirname "$0")" && pwd)
targets=$here/../../targets/spc-water
[ ! -e "$fit/course.tsv" ] || exit 0
mkdir -p "$fit/course"
rm -f "$fit/course/last"

# take CURVE K: the column of iteration K of its history, as a table.
take() {
    awk -F '\t' -v OFS='\t' -v k="$2" '
        /^#/ { for (c = 2; c <= NF; c++) if ($c == k) column = c; print "# r[lambda]", "omega"; next }
        { print $1, $column }' "$fit/$1_history.tsv" >"$fit/course/$1.tsv"
}

# friction K: the part of a scene.
friction() {
    if [ ! -e "$fit/omega_history.tsv" ]; then
        echo '"dissipative": {"law": "power", "sigma": 2.589, "inner_cutoff": 0.596, "cutoff": 1.72}'
        return
    fi
    take omega "$1"
    echo '"dissipative": {"law": "table", "file": "omega.tsv"}'
    [ -e "$fit/memory_slow_history.tsv" ] || return 0
    take memory_slow "$1"
    awk -F '\t' -v k="$1" '!/^#/ && $1 == k {
        print ", \"memory\": {\"slow\": {\"time\": " $2 ", \"omega\": {\"law\": \"table\", \"file\": \"memory_slow.tsv\"}}}"
    }' "$fit/numbers_history.tsv"
}

# The first iteration, each that took 1.5 times as long as the one before, and the last.
iterations=0
[ ! -e "$fit/timing.tsv" ] || iterations=$(awk '!/^#/ { if ($3 >= 1.5 * last) { print $1; last = $3; shown = $1 }; end = $1 }
    END { if (end != shown) print end }' "$fit/timing.tsv")
printf '# iteration\tprocessor_seconds[s]\tetd_rmse[1]\tnoise[1]\n' >"$fit/course.part"
for k in $iterations; do
    cat >"$fit/course/scene.json" <<END
{
    "seed": 7$seed,
    "box": [5.3874, 5.3874, 5.3874],
    "particles": {"count": 512},
    "temperature": 1,
    "time_step": 0.0039873725,
    "conservative": {"law": "table", "file": "$targets/potential_imc.tsv", "cutoff": 2.1505373737373734},
    $(friction "$k"),
    "etd": {"r_minimum": 0.5376344, "r_maximum": 1.0752688, "bins": 100, "times": 101, "every": 4, "origin_every": 10},
    "measure": {"equilibration": 1000, "samples": 160, "every": 80}
}
END
    # What has not changed is not simulated again.
    cat "$fit/course/scene.json" "$fit"/course/*.tsv >"$fit/course/now" 2>/dev/null || :
    if ! cmp -s "$fit/course/now" "$fit/course/last"; then
        mv "$fit/course/now" "$fit/course/last"
        "$mesofit" simulate "$fit/course/scene.json" -o "$fit/course/run" --threads 1 --quiet --force
    fi
    # Rows are times, columns first separations; what is not known of either is left out.
    awk -v k="$k" -v OFS='\t' '
        /^#/ { next }
        FILENAME ~ /timing/ { seconds[$1] = $3; next }
        { line = row[FILENAME]++ }
        FILENAME ~ /etd.tsv/ { for (c = 2; c <= NF; c++) E[line, c] = $c; next }
        FILENAME ~ /etd_error.tsv/ { for (c = 2; c <= NF; c++) error[line, c] = $c; next }
        FILENAME ~ /etd_se.txt/ { for (c = 3; c <= NF; c++) target_error[line, c - 1] = $c; next }
        line > 0 { for (c = 3; c <= NF; c++) if ($c != "nan" && target_error[line, c - 1] != "nan" && E[line, c - 1] != "nan" && error[line, c - 1] != "nan") {
            d = E[line, c - 1] - $c; s += d * d; m++
            n += error[line, c - 1] * error[line, c - 1] + target_error[line, c - 1] * target_error[line, c - 1] } }
        END { print k, seconds[k] + 0, sqrt(s / m), sqrt(n / m) }' \
        $([ ! -e "$fit/timing.tsv" ] || echo "$fit/timing.tsv") "$fit/course/run/etd.tsv" "$fit/course/run/etd_error.tsv" \
        "$targets/spc298_etd_se.txt" "$targets/spc298_etd_E.txt" >>"$fit/course.part"
done
mv "$fit/course.part" "$fit/course.tsv"
