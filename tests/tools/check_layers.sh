#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# check_layers.sh BUILD: every include "layer/…" follows src/layers.txt, and so does every symbol that
# an object of BUILD uses, since a list may declare what it lists; each foreign library or program is
# known to one file only. Run at the root of the source tree.
set -u
export LC_ALL=C.UTF-8

# Which room may use which, for awk: known[room], allowed[room, other].
rules='
    BEGIN {
        while ((getline line < "src/layers.txt") > 0) {
            if (line ~ /^#/ || line !~ /:/)
                continue
            layer = line
            sub(/:.*/, "", layer)
            sub(/^[^:]*:/, "", line)
            known[layer] = 1
            allowed[layer, layer] = 1
            count = split(line, uses, " ")
            for (i = 1; i <= count; i++)
                allowed[layer, uses[i]] = 1
        }
    }'

# Prints "file:line: layer may not include other" for each include that breaks a rule.
includes_against_the_rules() {
    find src -mindepth 2 -type f -name '*.[ch]' -exec awk "$rules"'
        FNR == 1 {
            split(FILENAME, parts, "/")
            layer = parts[2]
            if (!(layer in known))
                print FILENAME ": layer " layer " is not in src/layers.txt"
        }
        /^[ \t]*#[ \t]*include[ \t]*"/ {
            split($0, quoted, "\"")
            if (quoted[2] !~ /\//)
                next # a private header beside the file
            used = quoted[2]
            sub(/\/.*/, "", used)
            if (!((layer, used) in allowed))
                print FILENAME ":" FNR ": " layer " may not include " quoted[2]
        }' {} +
}

# Prints "file: layer may not use symbol of file" for each symbol of the program that breaks a rule.
symbols_against_the_rules() {
    find src -mindepth 2 -type f -name '*.c' | while IFS= read -r file; do
        object=$1/${file%.c}.o
        [ ! -e "$object" ] || echo "$object"
    done | xargs nm --extern-only --format=posix -A | awk -v build="$1/" "$rules"'
        {
            file = substr($1, length(build) + 1)
            sub(/:$/, "", file)
            split(file, parts, "/")
            if ($3 == "U") {
                user[++uses_made] = file
                symbol[uses_made] = $2
                from[uses_made] = parts[2]
            } else {
                home[$2] = file
                room[$2] = parts[2]
            }
        }
        END {
            for (n = 1; n <= uses_made; n++)
                if (symbol[n] in home && !((from[n], room[symbol[n]]) in allowed))
                    print user[n] ": " from[n] " may not use " symbol[n] " of " home[symbol[n]]
        }'
}

# only_in FILE PATTERN WHAT: prints the lines of other files that match the extended regex.
only_in() {
    grep -rnE --include='*.[ch]' "$2" src | grep -v "^$1:" |
        sed "s|\$|    ($3 belongs in $1 only)|"
}

faults=$(
    includes_against_the_rules
    symbols_against_the_rules "$1"
    only_in 'src/io/json[_a-z]*.c' 'include.*cJSON\.h' 'cJSON'
    only_in src/io/xml.c 'include.*expat\.h' 'expat'
    only_in src/base/ranks.c 'include.*mpi\.h' 'MPI'
    only_in src/live/live_server.c 'include.*microhttpd\.h' 'libmicrohttpd'
    only_in src/optimise/nlopt_driver.c 'include.*nlopt\.h' 'NLopt'
    only_in src/report/figure_script.c '"([^" ]*/)?gnuplot[" ]' 'gnuplot'
    only_in 'src/\(bench/bench_lammps\|export/export_lammps\).c' '"([^" ]*/)?lmp[" ]' 'LAMMPS'
    only_in src/report/program.c '\b(vfork|popen|system|exec[lv]p?e?|posix_spawnp?) ?\(' \
        'starting a program'
    only_in 'src/\(report/program\|trajectory/format_h5md\).c' '\bfork ?\(' 'starting a process'
    only_in src/base/clock.c 'pthread_(cond|mutex|rwlock)_timed|sem_timedwait|CLOCK_REALTIME|gettimeofday|\btime ?\((NULL|0|&)' \
        'waiting until a time, by a clock that is never set back,'
    only_in 'src/\(io/manifest\|io/tracked_files*\|io/output\|report/figure_script\|live/live_folder\|report/film\|bench/bench_lammps\|engines/engine_folder\).c' \
        '\b(unlink|unlinkat|rmdir|remove|rename|renameat) ?\(' \
        'removing or renaming files goes through io/tracked_files.h and io/output.h, and'
    only_in src/base/terminal.c '"[^"]*\\(033|x1[bB]|e\[)' 'a command of the terminal'
)
if [ -n "$faults" ]; then
    printf 'layers:\n%s\n' "$faults"
    exit 1
fi
echo 'layers: OK'
