#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# starts.sh: how far speeds are from Maxwell's, by the collisions of a disc so far, from three starts: starts.tsv and .png.
# MESOFIT is the program.
set -eu
export LC_ALL=C.UTF-8
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
rm -f starts.part
for start in signs uniform normal; do
    sed "s/\"velocities\": \"[a-z]*\"/\"velocities\": \"$start\"/" start.json >"start-$start.json"
    "$mesofit" simulate "start-$start.json" -o "out/start-$start" --threads 1 --quiet --force
    rm "start-$start.json"
    # u = 1 − exp(−m v²/2T) of every disc becomes uniform, whatever its mass: the largest distance of its distribution from
    # that (Kolmogorov and Smirnov), and what chance exceeds in one case of twenty.
    printf '# %s\n# collisions of a disc\tdistance[1]\tnoise[1]\n' "$start" >>starts.part
    awk -v OFS='\t' -v bins=1000 '
        function tell(    k, sum, far) {
            for (k = 0; k < bins; k++) {
                sum += count[k]
                d = sum / n - (k + 1) / bins
                far = d > far ? d : -d > far ? -d : far
                count[k] = 0
            }
            print so_far[frame++] + 0, far, 1.36 / sqrt(n)
        }
        FILENAME ~ /collisions/ { if (!/^#/) { all += $4 * ($2 - last); last = $2; so_far[++samples] = all }; next }
        NF == 1 { if (n) tell(); n = 0; next }
        /^Lattice/ { next }
        { count[int(bins * (1 - exp(-$14 * ($8 * $8 + $9 * $9) / 2)))]++; n++ }
        END { tell() }' "out/start-$start/collisions.tsv" "out/start-$start/snapshots/trajectory.extxyz" >>starts.part
    printf '\n\n' >>starts.part
done
mv starts.part starts.tsv
gnuplot -d starts.gp
