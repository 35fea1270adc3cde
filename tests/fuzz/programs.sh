#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# programs.sh PROGRAM MUTATE SECONDS: whole runs of the program, built with sanitizers, on damaged
# copies of tests/fuzz/corpus. A case with a file "prepare" is run with its words first, undamaged: its
# results are damaged, too. Findings stay beside the program; SEED chooses the damage.
set -eu

program=$(realpath "$1")
mutate=$(realpath "$2")
place=$(dirname "$program")/fuzz
rm -rf "$place/cases"
mkdir -p "$place/findings"
cp -r "$(dirname "$0")/corpus" "$place/cases"
# A finding ends the program with a report; an array above a gigabyte is want of memory; no figures.
export ASAN_OPTIONS=max_allocation_size_mb=1024:allocator_may_return_null=1:detect_leaks=1
export OMP_WAIT_POLICY=passive
for case in "$place"/cases/*; do
    if [ -f "$case/prepare" ]; then
        (cd "$case" && words=$(cat prepare) && PATH=/nowhere "$program" $words --quiet 2>prepared || [ $? -le 1 ])
        rm "$case/prepare"
    fi
done
"$mutate" "$program" "$place/cases" "$place/findings" "$3" "${SEED:-1}"
