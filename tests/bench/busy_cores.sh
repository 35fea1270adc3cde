#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Seconds that 3000 beads take with one thread and with two, on cores that are idle and beside two
# processes that never rest: the best and the median of TRIALS runs each, in turn. "as libgomp waits"
# is two threads that turn in circles for as long as libgomp lets them by itself.
#
# tests/bench/busy_cores.sh [PROGRAM]
# TRIALS=5, and SPINS="0 1000 10000" tries other numbers of turns.
set -eu
export LC_ALL=C.UTF-8
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:-$root/build/mesofit}")
trials=${TRIALS:-5}
folder=$(mktemp -d)
busy=
trap 'kill $busy 2>/dev/null || true; rm -rf "$folder"' EXIT INT TERM
cat >"$folder/scene.json" <<SCENE
{"title": "standard fluid", "seed": 1, "box": [10, 10, 10], "particles": {"count": 3000},
 "temperature": 1, "time_step": 0.02, "measure": {"equilibration": 50, "samples": 25, "every": 10},
 "conservative": {"law": "soft-repulsion", "a": 25}, "dissipative": {"law": "power", "sigma": 2.12}}
SCENE

# Seconds of one run: $1 threads, $2 what is set in its environment.
run() {
    begin=$(date +%s.%N)
    # shellcheck disable=SC2086
    env PATH=/nowhere $2 "$program" simulate "$folder/scene.json" -o "$folder/out" --threads "$1" \
        --quiet >/dev/null 2>&1
    end=$(date +%s.%N)
    echo "$begin $end" | awk '{print $2 - $1}'
}

measure() {
    rm -f "$folder"/times.*
    n=0
    while [ $n -lt "$trials" ]; do
        run 1 "" >>"$folder/times.1 thread"
        run 2 "" >>"$folder/times.2 threads"
        run 2 "GOMP_SPINCOUNT=300000" >>"$folder/times.2 threads, as libgomp waits"
        for spins in ${SPINS:-}; do
            run 2 "GOMP_SPINCOUNT=$spins" >>"$folder/times.2 threads, $spins turns"
        done
        n=$((n + 1))
    done
    for times in "$folder"/times.*; do
        sort -n "$times" | awk -v what="$1, ${times##*/times.}" \
            '{t[NR] = $1} END {printf "%-40s %8.3f s best %8.3f s median\n", what, t[1], t[int((NR + 1) / 2)]}'
    done
}

measure "idle cores"
for _ in 1 2; do
    sh -c 'while :; do :; done' &
    busy="$busy $!"
done
measure "busy cores"
