#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# run_tests.sh PROGRAM…: runs cmocka programs in turn, one line a program, the whole output of
# those that fail, and the total of their tests. The exit status says whether all passed.
set -u

LC_ALL=C # a decimal point in EPOCHREALTIME
# Threads that spin while they wait for each other take 100 times as long on a busy machine.
export OMP_WAIT_POLICY=passive
output=$(mktemp) || exit 1
trap 'rm -f "$output"' EXIT
passed=0 failed=0 skipped=0

# Prints "passed failed skipped" of the tests in $output. A test that began and ended neither OK
# nor SKIPPED has failed: that holds for failed checks, failed setups and crashes alike.
count_tests() {
    awk '
        /^\[ RUN      \] / { begun++; running = 1; next }
        running && /\[       OK \] / { passed++; running = 0 }
        running && /\[  SKIPPED \] / { skipped++; running = 0 }
        END { print passed + 0, begun - passed - skipped, skipped + 0 }' "$output"
}

# Prints why a program counts as failed although none of its tests did, or nothing.
find_fault() {
    if [ "$1" -gt 128 ]; then
        echo "died of signal $(kill -l "$(($1 - 128))")"
    elif [ "$1" -ne 0 ]; then
        echo "exit status $1"
    elif ! grep -q '^\[ RUN      \]' "$output"; then
        echo "ran no test"
    fi
}

run_program() {
    local begin=$EPOCHREALTIME code p f s note=
    # The braces keep the shell's own word about a crash off the screen.
    { "$1" >"$output" 2>&1; } 2>/dev/null
    code=$?
    local seconds
    seconds=$(awk "BEGIN { print $EPOCHREALTIME - $begin }")
    read -r p f s <<<"$(count_tests)"
    if [ "$f" -eq 0 ]; then
        note=$(find_fault "$code")
        [ -n "$note" ] && f=1
    elif [ "$code" -gt 128 ]; then
        note=$(find_fault "$code")
    fi
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    printf '%-6s %7.2f s  %3d passed  %s%s\n' "$([ "$f" -eq 0 ] && echo ok || echo FAILED)" \
        "$seconds" "$p" "$1" "${note:+: $note}"
    [ "$f" -eq 0 ] || sed 's/^/    /' "$output"
}

for program in "$@"; do
    run_program "$program"
done
total="total: $passed passed, $failed failed"
[ "$skipped" -eq 0 ] || total="$total, $skipped skipped"
echo "$total"
[ "$failed" -eq 0 ]
