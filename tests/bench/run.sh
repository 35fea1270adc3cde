#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Speed of the engine on this machine, on one thread: tables for people, and the same numbers in
# tests/bench/results/<cpu>.tsv, to be compared with those of other days. Nothing else should run.
# Usage: tests/bench/run.sh PROGRAM
set -euo pipefail
export LC_ALL=C.UTF-8
program=$1
results=$(dirname "$0")/results

# cpuinfo KEY: what /proc/cpuinfo says of the first processor.
cpuinfo() {
    sed -n "s/^$1[[:space:]]*: //p" /proc/cpuinfo | head -n 1
}

# "AMD EPYC" of family 26, model 2 is amd-epyc-26-2; other processors than x86 go by `uname -m`.
name=$(cpuinfo 'model name' | sed 's/([RTM]*)//g; s/ CPU.*//; s/ @.*//')
cpu=$(printf '%s %s %s' "${name:-$(uname -m)}" "$(cpuinfo 'cpu family')" "$(cpuinfo model)" |
    tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9]\{1,\}/-/g; s/^-//; s/-$//')
mkdir -p "$results"
"$program" bench engine --force -o "$results/$cpu.tsv"
printf '\nresults in %s\n' "$results/$cpu.tsv"
