#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Speed of the engine: every scene of tests/bench/scenes on one thread, best of three runs.
# Usage: tests/bench/run.sh PROGRAM
set -euo pipefail
program=$1
here=$(dirname "$0")
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
printf '# processor: %s\n' "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
printf '# scene\tsteps_per_second\n'
for scene in "$here"/scenes/*.json; do
    best=0
    for _ in 1 2 3; do
        "$program" simulate "$scene" -o "$out" --threads 1 --quiet
        rate=$(sed -n 's/.*"steps_per_second":[[:space:]]*\([0-9.]*\).*/\1/p' "$out/summary.json")
        best=$(awk -v a="$best" -v b="$rate" 'BEGIN { print (a > b ? a : b) }')
    done
    printf '%s\t%.0f\n' "$(basename "$scene" .json)" "$best"
done
