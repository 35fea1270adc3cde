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
    # u = 1 − exp(−E/⟨E⟩), E = m v²/2, of every disc becomes uniform, whatever its mass: the largest distance of its
    # distribution from that, and what chance exceeds in one case of twenty: H. W. Lilliefors, J. Am. Stat. Assoc. 64, 387
    # (1969). ⟨E⟩ is that of the discs, which is conserved, not that of the temperature that they were drawn by.
    printf '# %s\n# collisions of a disc\tdistance[1]\tnoise[1]\n' "$start" >>starts.part
    awk -v OFS='\t' -v bins=1000 '
        function tell(    i, k, sum, far) {
            for (i = 0; i < n; i++)
                count[int(bins * (1 - exp(-energy[i] * n / whole)))]++
            for (k = 0; k < bins; k++) {
                sum += count[k]
                d = sum / n - (k + 1) / bins
                far = d > far ? d : -d > far ? -d : far
                count[k] = 0
            }
            print so_far[frame++] + 0, far, 1.06 / sqrt(n)
            whole = 0
        }
        FILENAME ~ /collisions/ { if (!/^#/) { all += $4 * ($2 - last); last = $2; so_far[++samples] = all }; next }
        NF == 1 { if (n) tell(); n = 0; next }
        /^Lattice/ { next }
        { whole += energy[n++] = $14 * ($8 * $8 + $9 * $9) / 2 }
        END { tell() }' "out/start-$start/collisions.tsv" "out/start-$start/snapshots/trajectory.extxyz" >>starts.part
    printf '\n\n' >>starts.part
done
mv starts.part starts.tsv
gnuplot -d starts.gp
