#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run_tests.sh PROGRAM…: runs cmocka programs, as many at once as there are processors, or LANES of
# them; one line a program with its seconds of processor time and on the wall, the whole output of
# those that fail, the ten that worked longest, and the total of their tests. The exit status says
# whether all passed. What a program has worked is kept beside it, as PROGRAM.seconds or, with LONG
# (tests/shared/length.h), as PROGRAM.long.seconds; the next time those that are not known or work
# longest begin first, so that no lane waits at the end.
set -u

# Threads that spin while they wait for each other take 100 times as long on a busy machine.
export OMP_WAIT_POLICY=passive
# A process that works longer is lost [s].
ulimit -S -t 3600

# Prints "passed failed skipped" of the tests in the file $1. A test that began and ended neither
# OK nor SKIPPED has failed: that holds for failed checks, failed setups and crashes alike.
count_tests() {
    awk '
        /^\[ RUN      \] / { begun++; running = 1; next }
        running && /\[       OK \] / { passed++; running = 0 }
        running && /\[  SKIPPED \] / { skipped++; running = 0 }
        END { print passed + 0, begun - passed - skipped, skipped + 0 }' "$1"
}

# Prints why a program with exit status $1 and the output $2 counts as failed although none of its
# tests did, or nothing.
find_fault() {
    if [ "$1" -gt 128 ]; then
        echo "died of signal $(kill -l "$(($1 - 128))")"
    elif [ "$1" -ne 0 ]; then
        echo "exit status $1"
    elif ! grep -q '^\[ RUN      \]' "$2"; then
        echo "ran no test"
    fi
}

# Runs the program $1, tells of it, and leaves its counts as a line of the file $2.
run_program() {
    local code p f s note="" output wall work TIMEFORMAT='%R %U %S'
    output=$(mktemp) || exit 1
    # The braces keep the shell's own word about a crash off the screen.
    { time "$1" >"$output" 2>&1; } 2>"$output.times"
    code=$?
    # Whatever the locale of the tests, with a decimal point here.
    read -r wall work <<<"$(tail -n 1 "$output.times" | tr , . | LC_ALL=C awk '{ printf "%.2f %.2f", $1, $2 + $3 }')"
    read -r p f s <<<"$(count_tests "$output")"
    if [ "$f" -eq 0 ]; then
        note=$(find_fault "$code" "$output")
        [ -n "$note" ] && f=1
    elif [ "$code" -gt 128 ]; then
        note=$(find_fault "$code" "$output")
    fi
    [ "$f" -eq 0 ] && echo "$work" >"$1${LONG:+.long}.seconds"
    echo "$p $f $s $work $1" >>"$2"
    {
        printf '%-6s %7s s work %7s s wall  %3d passed  %s%s\n' "$([ "$f" -eq 0 ] && echo ok || echo FAILED)" \
            "$work" "$wall" "$p" "$1" "${note:+: $note}"
        [ "$f" -eq 0 ] || sed 's/^/    /' "$output"
    } | flock "$2" cat
    rm -f "$output" "$output.times"
}

# Prints the programs, each followed by a zero byte: longest first.
in_order() {
    for program in "$@"; do
        echo "$(cat "$program${LONG:+.long}.seconds" 2>/dev/null || echo 1e9) $program"
    done | LC_ALL=C sort -s -g -r -k 1,1 | cut -d ' ' -f 2- | tr '\n' '\0'
}

counts=$(mktemp) || exit 1
trap 'rm -f "$counts"' EXIT
trap 'exit 130' INT
export -f run_program count_tests find_fault
# shellcheck disable=SC2016
in_order "$@" |
    xargs -0 -n 1 -P "${LANES:-$(nproc)}" bash -c 'run_program "$2" "$1"' run_program "$counts"
read -r passed failed skipped work <<<"$(LC_ALL=C awk '{ p += $1; f += $2; s += $3; work += $4 }
    END { printf "%d %d %d %.0f", p, f, s, work }' "$counts")"
echo "longest of $# programs, which worked $work s:"
LC_ALL=C sort -s -g -r -k 4,4 "$counts" | head -n 10 | LC_ALL=C awk '{ printf "    %7.2f s  %s\n", $4, $5 }'
# One whose lane was killed has left no line.
lost=$(($# - $(wc -l <"$counts")))
[ "$lost" -eq 0 ] || echo "$lost programs did not come to their end"
total="total: $passed passed, $((failed + lost)) failed"
[ "$skipped" -eq 0 ] || total="$total, $skipped skipped"
[ -n "${ENGINES:-}" ] || echo "ENGINES=1 runs those in which LAMMPS or GROMACS runs, too"
echo "$total"
[ "$((failed + lost))" -eq 0 ]
