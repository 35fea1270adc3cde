#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: runs of growing length, and the rms over their bins of the standard errors of g and E:
# out/noise.tsv and noise.png. MESOFIT is the program.
set -eu
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
mkdir -p out
printf '# samples\torigins\tg_error\tE_error\n' >out/noise.tsv
for samples in 9 17 33 49 97; do
    # Files that it names are found from its own folder.
    sed "s/\"samples\": 49/\"samples\": $samples/" water.json >"water-$samples.json"
    "$mesofit" simulate "water-$samples.json" -o "out/$samples" --quiet --force
    rm "water-$samples.json"
    g=$(awk '!/^#/ && $3 > 0 { n++; s += $3 * $3 } END { print sqrt(s / n) }' "out/$samples/rdf.tsv")
    E=$(awk '!/^#/ { for (k = 2; k <= NF; k++) if ($k > 0) { n++; s += $k * $k } } END { print n ? sqrt(s / n) : "nan" }' "out/$samples/etd_error.tsv")
    printf '%d\t%d\t%s\t%s\n' "$samples" $((samples * 50 / 200)) "$g" "$E" >>out/noise.tsv
done
gnuplot -d figure.gp
cat out/noise.tsv
