#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# work_precision.sh: the viscosity of the solvent by three scenes, each an eighth, a quarter, half and all of its
# samples: processor time, viscosity, its error, and what kinetic theory says; work_precision.tsv and .png.
# MESOFIT is the program.
set -eu
export LC_ALL=C
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}

# Puts the processor seconds of all children so far into $seconds; in a subshell there would be none.
read_seconds() {
    times >out/times
    seconds=$(awk -F '[ms ]' 'NR == 2 { print 60 * $1 + $2 + 60 * $4 + $5 }' out/times)
}

number() { # KEY FILE
    awk -F '[:,]' -v key="\"$1\"" 'index($1, key) { print $2 + 0; exit }' "$2"
}

printf '# samples\tprocessor_seconds[s]\tviscosity\tviscosity_error\tviscosity_theory\n' >work_precision.part
for scene in channel wave tagged; do
    [ "$scene" = channel ] || printf '\n\n' >>work_precision.part
    printf '# %s\n' "$scene" >>work_precision.part
    all=$(sed -n 's/.*"samples": \([0-9]*\).*/\1/p' "$scene.json")
    for part in 8 4 2 1; do
        sed "s/\"samples\": $all/\"samples\": $((all / part))/" "$scene.json" >"$scene-$part.json"
        read_seconds
        begun=$seconds
        "$mesofit" simulate "$scene-$part.json" -o "out/$scene-$part" --threads 1 --quiet --force
        rm "$scene-$part.json"
        summary=out/$scene-$part/summary.json
        read_seconds
        printf '%d\t%.2f\t%s\t%s\t%s\n' $((all / part)) "$(echo "$seconds $begun" | awk '{ print $1 - $2 }')" \
            "$(number viscosity "$summary")" "$(number viscosity_error "$summary")" \
            "$(number viscosity_theory "$summary")" >>work_precision.part
    done
done
mv work_precision.part work_precision.tsv
cat work_precision.tsv
gnuplot -d work_precision.gp
