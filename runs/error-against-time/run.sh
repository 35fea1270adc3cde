#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: what is known by theory, from scenes with an eighth, a quarter, half and all of their samples: processor time,
# value, its error, and the theory; error-against-time.tsv and .png. MESOFIT is the program.
set -eu
export LC_ALL=C
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
mkdir -p out

# Puts the processor seconds of all children so far into $seconds; in a subshell there would be none.
read_seconds() {
    times >out/times
    seconds=$(awk -F '[ms ]' 'NR == 2 { print 60 * $1 + $2 + 60 * $4 + $5 }' out/times)
}

number() { # KEY FILE
    awk -F '[:,]' -v key="\"$1\"" 'index($1, key) { print $2 + 0; exit }' "$2"
}

# KEY of the summary, FOLDER and SCENE.
measure() {
    [ ! -s error-against-time.part ] || printf '\n\n' >>error-against-time.part
    printf '# %s: %s\n# samples\tprocessor_seconds[s]\tvalue\terror\ttheory\n' "$3" "$1" >>error-against-time.part
    all=$(sed -n 's/.*"samples": \([0-9]*\).*/\1/p' "../$2/$3.json")
    for part in 8 4 2 1; do
        sed "s/\"samples\": $all/\"samples\": $((all / part))/" "../$2/$3.json" >"out/$3-$part.json"
        read_seconds
        begun=$seconds
        "$mesofit" simulate "out/$3-$part.json" -o "out/$3-$part" --threads 1 --quiet --force
        summary=out/$3-$part/summary.json
        read_seconds
        printf '%d\t%.2f\t%s\t%s\t%s\n' $((all / part)) "$(echo "$seconds $begun" | awk '{ print $1 - $2 }')" \
            "$(number "$1" "$summary")" "$(number "$1_error" "$summary")" "$(number "$1_theory" "$summary")" \
            >>error-against-time.part
    done
}

rm -f error-against-time.part
for scene in channel wave tagged; do
    measure viscosity collision-dynamics "$scene"
done
for scene in discs spheres; do
    measure compressibility_factor kinetic-gas "$scene"
done
measure effective_diffusion active-brownian free
mv error-against-time.part error-against-time.tsv
cat error-against-time.tsv
gnuplot -d error_against_time.gp
