#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run_tests.sh PROGRAM…: runs cmocka programs, as many at once as there are processors, or LANES of
# them; one line a program, the whole output of those that fail, and the total of their tests. The
# exit status says whether all passed.
set -u

# Tests run under the user's locale; what is reckoned here has a decimal point.
export LOCALE_OF_TESTS=${LC_ALL-} LC_ALL=C.UTF-8
# Threads that spin while they wait for each other take 100 times as long on a busy machine.
export OMP_WAIT_POLICY=passive

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
    local begin=$EPOCHREALTIME code p f s note="" output seconds
    output=$(mktemp) || exit 1
    # The braces keep the shell's own word about a crash off the screen.
    { LC_ALL=$LOCALE_OF_TESTS "$1" >"$output" 2>&1; } 2>/dev/null
    code=$?
    seconds=$(awk "BEGIN { print $EPOCHREALTIME - $begin }")
    read -r p f s <<<"$(count_tests "$output")"
    if [ "$f" -eq 0 ]; then
        note=$(find_fault "$code" "$output")
        [ -n "$note" ] && f=1
    elif [ "$code" -gt 128 ]; then
        note=$(find_fault "$code" "$output")
    fi
    echo "$p $f $s" >>"$2"
    {
        printf '%-6s %7.2f s  %3d passed  %s%s\n' "$([ "$f" -eq 0 ] && echo ok || echo FAILED)" \
            "$seconds" "$p" "$1" "${note:+: $note}"
        [ "$f" -eq 0 ] || sed 's/^/    /' "$output"
    } | flock "$2" cat
    rm -f "$output"
}

counts=$(mktemp) || exit 1
trap 'rm -f "$counts"' EXIT
trap 'exit 130' INT
export -f run_program count_tests find_fault
# shellcheck disable=SC2016
printf '%s\0' "$@" |
    xargs -0 -n 1 -P "${LANES:-$(nproc)}" bash -c 'run_program "$2" "$1"' run_program "$counts"
read -r passed failed skipped <<<"$(awk '{ p += $1; f += $2; s += $3 }
    END { print p + 0, f + 0, s + 0 }' "$counts")"
# One whose lane was killed has left no line.
lost=$(($# - $(wc -l <"$counts")))
[ "$lost" -eq 0 ] || echo "$lost programs did not come to their end"
total="total: $passed passed, $((failed + lost)) failed"
[ "$skipped" -eq 0 ] || total="$total, $skipped skipped"
echo "$total"
[ "$((failed + lost))" -eq 0 ]
