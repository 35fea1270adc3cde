#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: how far off each system is by time step and one number more, one thread: time-steps.tsv and .png. What is in
# out/ is not run again. MESOFIT is the program, SEEDS are the seeds.
set -eu
export LC_ALL=C.UTF-8
cd "$(dirname "$0")"
mesofit=${MESOFIT:-../../mesofit}
seeds=${SEEDS:-1 2 3}
mkdir -p out

# simulate FOLDER TIME_STEP REST LENGTH SCENE KEY VALUE…: SCENE with other values of some keys, for a time REST before
# the first of its samples and LENGTH from there to the last. There is no FOLDER/summary.json if it ended as unstable.
simulate() {
    local out=$1 step=$2 rest=$3 length=$4 scene=$5 samples every code=0
    shift 5
    [ ! -e "$out/done" ] || return 0
    samples=$(sed -n 's/.*"samples": \([0-9]*\).*/\1/p' "$scene.json")
    every=$(awk "BEGIN { n = int($length / $samples / $step + 0.5); print n < 1 ? 1 : n }")
    set -- time_step "$step" every "$every" equilibration "$(awk "BEGIN { printf \"%d\", $rest / $step }")" "$@"
    cp "$scene.json" point.json
    while [ $# -gt 0 ]; do
        sed -i -E "s|(\"$1\": )[^],}]*|\1${2//SEED/$seed}|" point.json
        shift 2
    done
    "$mesofit" simulate point.json -o "$out" --seed "$seed" --threads 1 --quiet --force >out/says 2>&1 || code=$?
    rm point.json
    # Of temperatures that are off the program says that it has not converged.
    [ "$code" -le 1 ] || { cat out/says >&2; exit 1; }
    touch "$out/done"
}

number() { # KEY FOLDER
    awk -F '[:,]' -v key="\"$1\":" 'index($1 ":", key) { print $2 + 0; exit }' "$2/summary.json"
}

shortest() { # the same point with the shortest step
    echo "${1%-*-*}-0-$seed"
}

# The measures of an error, of a folder. The energy of a particle, which nothing but the time step changes, scatters by so
# many k_B T about its mean.
energy() {
    awk -v temperature="$(number temperature "$(shortest "$1")")" '
        !/^#/ { s += $7; ss += $7 * $7; n++ } END { v = (ss - s * s / n) / n; print sqrt(v > 0 ? v : 0) / temperature }' "$1/thermodynamics.tsv"
}
temperature() { # of a fluid at T = 1: the one that is farther off
    awk "BEGIN { a = $(number temperature "$1") - 1; b = $(number temperature_configurational "$1") - 1
        print (a * a > b * b) ? a : b }"
}
configurational() {
    awk "BEGIN { print $(number temperature_configurational "$1") - 1 }"
}
viscosity() {
    awk "BEGIN { print $(number viscosity "$1") / $(number viscosity_theory "$1") - 1 }"
}
overlap() { # potential energy beside that of the shortest step
    awk "BEGIN { print $(number potential_energy "$1") / $(number potential_energy "$(shortest "$1")") - 1 }"
}

# map NAME MEASURE REST LENGTH SCENE KEY "VALUES" "TIME_STEPS" [KEY VALUE]…: a row for each value, a column for each step;
# rows of the table are map, row, column, value, time step, error (mean of the seeds), its standard error by their scatter,
# how many were unstable, the Schmidt number of a solvent.
map() {
    local name=$1 measure=$2 rest=$3 length=$4 scene=$5 key=$6 values=$7 steps=$8 row=0 column value step out
    shift 8
    for value in $values; do
        column=0
        for step in $steps; do
            rm -f out/point
            for seed in $seeds; do
                out=out/$name-$row-$column-$seed
                simulate "$out" "$step" "$rest" "$length" "$scene" "$key" "$value" "$@"
                if [ -e "$out/summary.json" ]; then
                    echo "$("$measure" "$out") $(number schmidt_number "$out")"
                else
                    echo unstable
                fi >>out/point
            done
            awk -v OFS='\t' -v name="$name" -v row=$row -v column=$column -v value="$(basename "${value//\"/}" -SEED.json)" -v step="$step" '
                /unstable/ { unstable++; next }
                { s += $1; ss += $1 * $1; schmidt += $2; n++ }
                END {
                    error = (n > 1) ? sqrt((ss - s * s / n) / n / (n - 1)) : "nan"
                    print name, row, column, value, step, n ? s / n : "nan", error, unstable + 0, n ? schmidt / n : "nan"
                }' out/point
            column=$((column + 1))
        done
        row=$((row + 1))
    done >>time-steps.part
    printf '\n\n' >>time-steps.part
}

printf '# map\trow\tcolumn\tvalue\ttime_step[tau]\terror[1]\terror_error[1]\tunstable\tschmidt_number[1]\n' >time-steps.part
# A Lennard-Jones fluid is brought to its temperature with friction, and then left alone.
for seed in $seeds; do
    for temperature in 0.75 1.5 3 6 12; do
        simulate "out/start-$temperature-$seed" 0.001 3 0.5 lennard-jones-start temperature "$temperature"
        cp "out/start-$temperature-$seed/snapshots/step_000003500.json" "out/$temperature-$seed.json"
    done
done
map lennard-jones energy 0 4 lennard-jones placement \
    '"file","file":"out/0.75-SEED.json" "file","file":"out/1.5-SEED.json" "file","file":"out/3-SEED.json" "file","file":"out/6-SEED.json" "file","file":"out/12-SEED.json"' \
    "0.0005 0.001 0.002 0.004 0.008 0.012 0.016 0.024"
map water temperature 2.5 5 water integrator '"dpd-verlet" "dpd-vv" "shardlow" "lowe-andersen" "aboba-implicit" "aboba"' \
    "0.001 0.002 0.003 0.004 0.006 0.008 0.012 0.016"
map soft-discs energy 0.1 0.1 soft-discs strength "0.01 0.1 1 10 100" \
    "0.00005 0.0001 0.0002 0.0005 0.001 0.002 0.005"
map brownian configurational 2 5 brownian a "6.25 12.5 25 50 100" \
    "0.0005 0.001 0.002 0.004 0.008 0.016 0.032 0.064"
map euler-maruyama configurational 2 5 brownian a "6.25 12.5 25 50 100" \
    "0.0005 0.001 0.002 0.004 0.008 0.016 0.032 0.064" integrator '"euler-maruyama"'
map active-discs overlap 10 120 active-discs a "5 10 20 40 80" \
    "0.0025 0.005 0.01 0.02 0.04 0.08 0.16 0.32"
map collision-dynamics viscosity 30 300 collision-dynamics angle "60 90 110 130 150" "0.05 0.1 0.2 0.4 0.8 1.6"
mv time-steps.part time-steps.tsv
gnuplot -d time_steps.gp
