#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Fit the systems of the standard set by the defaults of the program and put them into one table and one figure.
#
# run.sh [NAME...]: these, else all. A system that has ended is not fitted again unless its files, the program or
# the options changed; one that was interrupted goes on where it stopped. When all were asked for, table, figure
# and the part of README.md between its marks are replaced.
#
# PROGRAM  default: build/mesofit
# OUT      results, table.tsv, table.md, time.md, notes.md and standard-set.png; default: out beside this script
# SEED     of the fits, instead of that of the program
# START    mean-force: begin with the potential of mean force
# THREADS  default: 2
# LIMIT    seconds of processor time a system; default: 960, eight minutes of two cores
# TABLE    1: no fit, the table of what OUT holds
set -eu
export LC_ALL=C.UTF-8 OMP_WAIT_POLICY=passive
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${PROGRAM:-$here/../../build/mesofit}")
seed=${SEED:-}
start=${START:-}
out=${OUT:-$here/out${seed:+/seed-$seed}${start:+/$start}}
threads=${THREADS:-2}
limit=${LIMIT:-960}
systems="
gaussian-core-1 gaussian-core-2 gaussian-core-3 gaussian-core-4 gaussian-core-5 gaussian-core-6 gaussian-core-7 gaussian-core-8
lennard-jones-triple lennard-jones-critical wca yukawa argon spc-water spce-water toluene toluene-pressure
two-dimensions-lennard-jones two-dimensions-wca two-dimensions-shoulder-0.1 two-dimensions-shoulder-0.3
shoulder-cold shoulder-warm hertzian star-polymer double-well two-dimensions-shoulder-cold
mixture-votca mixture-dilute mixture-solute mixture-sizes-attractive mixture-sizes-repulsive urea-water
chain-in-vacuum chains-of-six rings polymer-solvent propane hexane octane acetone
kremer-grest dumbbells lennard-jones-chains ring-melt"

# $1 system: its run file. FOLDER-SUFFIX is FOLDER/run-SUFFIX.json, FOLDER is FOLDER/run.json or, as `measure`
# wrote it, FOLDER/target.json.
run_file() {
    for folder in "$here"/*/; do
        folder=${folder%/}
        case $1 in
        "$(basename "$folder")")
            for file in "$folder/run.json" "$folder/target.json"; do
                [ ! -e "$file" ] || { echo "$file" && return; }
            done
            ;;
        "$(basename "$folder")"-*)
            file=$folder/run-${1#"$(basename "$folder")"-}.json
            [ ! -e "$file" ] || { echo "$file" && return; }
            ;;
        esac
    done
    echo "no system $1 in $here" >&2
    return 1
}

# $1 run file: what the result follows from.
digest() {
    {
        cat "$program" "$1"
        sed -n 's/.*"file":[[:space:]]*"\([^"]*\)".*/\1/p' "$1" | while IFS= read -r name; do
            cat "$(dirname "$1")/$name"
        done
        echo "$seed $limit $start"
    } | sha256sum | cut -d ' ' -f 1
}

# $1 run file, $2 folder: the run file that is fitted, a copy with the start if one is asked for.
begin_with() {
    [ -n "$start" ] || { echo "$1" && return; }
    sed "0,/{/ s|{|{\"method\": {\"start\": \"$start\"},|; s|\(\"file\":[[:space:]]*\"\)|\1$(dirname "$1")/|g" "$1" >"$2/run.json"
    echo "$2/run.json"
}

# $1 system. Its folder holds the result in fit/, what the program said in messages, a line "wall user system" of
# each piece in seconds, and the digest when it has ended.
fit() {
    file=$(run_file "$1")
    now=$(digest "$file")
    folder=$out/$1
    if [ "$(cat "$folder/ended" 2>/dev/null)" = "$now" ]; then
        return
    fi
    resume=
    if [ "$(cat "$folder/begun" 2>/dev/null)" = "$now" ] && [ -e "$folder/fit/checkpoint.bin" ]; then
        resume=--resume
    else
        rm -rf "$folder"
        mkdir -p "$folder"
        echo "$now" >"$folder/begun"
    fi
    echo "$1" >&2
    begins=$(begin_with "$file" "$folder")
    code=0
    used=$(awk '{ used += $2 + $3 } END { printf "%d", used }' "$folder/seconds" 2>/dev/null) || used=0
    (
        ulimit -c 0 && ulimit -S -t $((limit > used ? limit - used : 1))
        exec /usr/bin/time -a -o "$folder/seconds" -f '%e %U %S' "$program" fit "$begins" -o "$folder/fit" \
            --threads "$threads" --quiet ${seed:+--seed "$seed"} $resume >>"$folder/messages" 2>&1
    ) || code=$?
    echo "$code" >"$folder/code"
    [ "$code" -ne 130 ] || exit 130
    echo "$now" >"$folder/ended"
}

# $1 system: a row of the table.
row() {
    folder=$out/$1
    result=$folder/fit
    if [ ! -e "$folder/ended" ]; then
        printf '%s\t-%s\n' "$1" "$(printf '\tnan%.0s' $(seq 22))"
        return
    fi
    truths=
    file=$(run_file "$1")
    # What an unfinished fit left is no result.
    summary=$result/summary.json
    [ "$(cat "$folder/code")" -le 1 ] || summary=/dev/null
    if [ -s "$summary" ] && [ -n "$(find "$(dirname "$file")" -name 'truth*')" ]; then
        # shellcheck disable=SC2046
        truths=$(awk -v member="$1" -f "$here/truth.awk" $(find "$result" -maxdepth 1 -name '*.tsv' |
            grep -E '/(potential|bonds|angles|dihedrals)[^/]*\.tsv$' | grep -vE '_(flat|history)\.tsv$' | sort))
    fi
    {
        awk '{ wall += $1; processor += $2 + $3 } END { print "wall", wall; print "processor", processor }' \
            "$folder/seconds"
        echo "code $(cat "$folder/code")"
        awk -F '\t' -v name="$1" '$1 == name { print "true_pressure", $2; print "true_pressure_error", $3 }' "$here/pressures.tsv"
        sed -n 's/.*"temperature":[[:space:]]*\([0-9.]*\).*/wanted \1/p' "$file" | tail -n 1
        echo "$truths"
        [ ! -e "$result/history.tsv" ] || grep -vc '^#' "$result/history.tsv" | sed 's/^/passed /'
        # The keys of the first level alone.
        sed -n 's/^\t"\([a-z_]*\)":\t"*\([^"]*[^",]\)"*,*$/\1 \2/p' "$summary"
    } | awk -v name="$1" -f "$here/row.awk"
}

# $1 system: what it said of itself, if it has not converged.
note() {
    result=$out/$1/fit
    [ -e "$out/$1/ended" ] || return 0
    if grep -qs '"status":.*"converged"' "$result/summary.json"; then
        return 0
    fi
    if [ "$(cat "$out/$1/code")" -gt 128 ]; then
        text="ended by the limit of $limit s of processor time"
        [ ! -e "$result/history.tsv" ] || text="$text $(awk '!/^#/ { n++; error = $4; noise = $5 }
            END { printf "after %d iterations; the error was %.2g, its noise %.2g", n, error, noise }' "$result/history.tsv")"
    elif [ -e "$result/summary.json" ]; then
        text=$(sed -n 's/^\t"reason":\t"\(.*\)",*$/\1/p' "$result/summary.json")
    else
        text=$(grep '^mesofit:' "$out/$1/messages" | grep -v 'warning:' | head -n 1 | sed "s|$here/||g; s|$out/||g; s/^mesofit: //")
    fi
    echo "- $1: $text"
}

all=
if [ $# -eq 0 ]; then
    all=yes
    # shellcheck disable=SC2086
    set -- $systems
fi
mkdir -p "$out"
if [ -z "${TABLE:-}" ]; then
    for name; do
        fit "$name"
    done
fi

{
    printf '# system\tstatus\titerations\twall[s]\tprocessor[s]\tg\tlengths\tangles\tdihedrals\ttemperature[%%]\terror[%%]'
    printf '\tconfigurational[%%]\terror[%%]\tpressure\terror\topen\toff\tz\tz_without_way\tz_bonded'
    printf '\tg_error\tlengths_error\tangles_error\tdihedrals_error\n'
    for name in $systems; do
        row "$name"
    done
} >"$out/table.tsv"
for name in $systems; do
    note "$name"
done >"$out/notes.md"
awk -f "$here/markdown.awk" "$out/table.tsv" >"$out/table.md"
MESOFIT_PLOTS=$here/../../plots MESOFIT_TABLE=$out/table.tsv MESOFIT_FIGURE=$out/standard-set.png gnuplot "$here/standard-set.gp"
cat "$out/table.md"
ended=()
for name in $systems; do
    [ ! -e "$out/$name/ended" ] || [ ! -e "$out/$name/fit/summary.json" ] || ended+=("$out/$name/fit")
done
"$here/time.sh" "${ended[@]}" >"$out/time.md"
if [ -n "$all" ] && [ -z "$seed$start" ] && [ -z "${TABLE:-}" ]; then
    cp "$out/table.tsv" "$out/standard-set.png" "$here"
    awk -v table="$out/table.md" -v notes="$out/notes.md" '
        function insert(file,    line) { while ((getline line <file) > 0) print line }
        /^<!-- end -->/ { inside = 0 }
        !inside
        /^<!-- table -->/ { inside = 1; insert(table); print ""; insert(notes); print "\n![The table as a figure](standard-set.png)" }' "$here/README.md" >"$out/README.md"
    cp "$out/README.md" "$here/README.md"
fi
