#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# results.sh PROGRAM RUN…: runs each file that a README of RUN asks for, and writes what came out where it
# asks: between
#     <!-- results FILE: NUMBER … ; FIGURE … -->
# and <!-- end -->, numbers of summary.json as value(error) with version, machine, seed and processor time;
# the figures become FILE-FIGURE.png beside the README.
set -eu
program=$(realpath "$1")
shift
here=$(cd "$(dirname "$0")" && pwd)
machine=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1)
version=$("$program" --version | head -n 1)

# The block of one file, from its summary: numbers (asked for in $2) of the file $1.
block() {
    printf '| %s, seed %s | |\n|---|---|\n' "$1" "$3"
    awk -f "$here/results.awk" -v wanted="$2" "$4"
    printf '\n%s, %s: %s s of processor time.\n' "$version" "${machine:-unknown machine}" "$5"
}

run() {
    file=$1 numbers=$2 figures=$3
    out=$(mktemp -d)
    verb=simulate
    grep -q '"target"' "$file" && verb=fit
    # An unconverged fit has results, too.
    ("$program" "$verb" "$file" -o "$out/run" --quiet --force >/dev/null 2>"$out/says" || [ -f "$out/run/summary.json" ]; code=$?
        times >"$out/times"; exit $code) || { cat "$out/says" >&2; exit 1; }
    seconds=$(awk 'NR == 2 { for (k = 1; k <= 2; k++) { split($k, part, "m"); s += 60 * part[1] + part[2] } printf "%.1f", s }' "$out/times")
    seed=$(sed -n 's/.*"seed":[^0-9]*\([0-9]*\).*/\1/p' "$out/run/summary.json" | head -n 1)
    block "$file" "$numbers" "$seed" "$out/run/summary.json" "$seconds" >"$out/block"
    awk -v file="$file" -v block="$out/block" '
        skip && /^<!-- end -->/ { skip = 0 }
        !skip { print }
        index($0, "<!-- results " file ":") == 1 { print ""; while ((getline line < block) > 0) print line; print ""; skip = 1 }
    ' README.md >"$out/README.md" && cp "$out/README.md" README.md
    for figure in $figures; do
        cp "$out/run/figures/$figure.png" "${file%.json}-$figure.png"
    done
    rm -r "$out"
}

for folder in "$@"; do
    cd "$folder"
    grep -q '^<!-- results ' README.md || { echo "$folder/README.md asks for no results: <!-- results scene.json: pressure; simulation -->, <!-- end -->" >&2; exit 2; }
    sed -n 's/^<!-- results \([^:]*\): *\([^;]*\);* *\(.*\) -->$/\1|\2|\3/p' README.md | while IFS='|' read -r file numbers figures; do
        run "$file" "$numbers" "$figures"
    done
    cd - >/dev/null
done
