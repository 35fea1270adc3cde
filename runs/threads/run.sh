#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run.sh: what threads are worth: one simulation, and the first generation of a genetic algorithm, with 1, 2, 4, …
# threads up to the cores of this machine, in turn; the best of TRIALS (default 3) each: threads.tsv and threads.png.
# MESOFIT is the program.
#
# Seconds by the clock are those of an idle machine only if it is one. So the processor time of the busiest thread is
# measured, too: what the clock would show if every thread had a core to itself and never waited.
set -eu
export LC_ALL=C
cd "$(dirname "$0")"
mesofit=${MESOFIT:-mesofit}
trials=${TRIALS:-3}
threads=1
while [ $((2 * ${threads##* })) -le "$(nproc)" ]; do threads="$threads $((2 * ${threads##* }))"; done
mkdir -p out
: >out/trials

# Seconds of processor time that the busiest thread of a process had, looked at until it ends.
watch() { # PROCESS
    local busiest=0 now
    while now=$(cat /proc/"$1"/task/*/schedstat 2>/dev/null | sort -n | tail -n 1 | cut -d ' ' -f 1) && [ -n "$now" ] &&
        ! grep -q '^State:.*Z' /proc/"$1"/status 2>/dev/null; do
        [ "$now" -le "$busiest" ] || busiest=$now
        sleep 0.05
    done
    echo "$busiest" | awk '{ print $1 / 1e9 }'
}

for _ in $(seq "$trials"); do
    for job in simulate fit; do
        for n in $threads; do
            begun=$(date +%s.%N)
            "$mesofit" "$job" "$job.json" -o out/run --threads "$n" --quiet --force >/dev/null 2>&1 &
            busiest=$(watch $!)
            wait $! || true # a fit that ends after a generation has not converged
            echo "$job $n $busiest $(echo "$(date +%s.%N) $begun" | awk '{ print $1 - $2 }')" >>out/trials
        done
    done
done
sort -k1,1r -k2,2n -k3,3n out/trials | awk -v OFS='\t' '
    BEGIN { print "# job", "threads", "busiest_thread[s]", "clock[s]", "speed" }
    $1 " " $2 == last { next }
    { last = $1 " " $2; if ($1 != job) { if (job) printf "\n\n"; job = $1; one = $3 }
      print $1, $2, $3, $4, one / $3 }' >threads.tsv
cat threads.tsv
gnuplot -d figure.gp
