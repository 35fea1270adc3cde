#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# check_names.sh LIBRARY…: what the linker sees begins with mf_, or with mesofit_ if a public header
# declares it. Behind mf_, every function and object of x_y.o is called x_y, or x_ys if it is the
# list of them, or begins with x_, the first word of its file: files of one module, such as genetic.c
# and genetic_operators.c, share it.
set -u
export LC_ALL=C.UTF-8

symbols=$(nm --defined-only --extern-only --format=posix "$@") || exit 1
if [ -z "$symbols" ]; then
    echo "names: no symbol found in $*"
    exit 1
fi
faults=$(printf '%s\n' "$symbols" | awk '
    /\.o\]?:$/ {
        file = $0
        sub(/^.*[[\/]/, "", file)
        sub(/\.o\]?:$/, "", file)
        word = file
        sub(/_.*$/, "", word)
        next
    }
    NF >= 2 && index($1, "mesofit_") == 1 {
        next
    }
    NF >= 2 {
        name = $1
        if (sub(/^mf_/, "", name) != 1 || (name != file && name != file "s" && index(name, word "_") != 1))
            print file ".c: " $1 " should begin with mf_" word "_"
    }')
if [ -n "$faults" ]; then
    printf 'names:\n%s\n' "$faults"
    exit 1
fi
echo 'names: OK'
