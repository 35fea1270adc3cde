#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# lint.sh LIBRARY…: every check that needs no run of the program. One line "name: OK" a check, or
# the offending lines; the exit status says whether all passed.
set -u
export LC_ALL=C.UTF-8

library=$(realpath "$1")
libraries=$(realpath "$@")
cd "$(dirname "$0")/../.." || exit 1

# Files that belong to the project, committed or not yet, one a line. What came with a target
# stays as it was when the target was measured.
project_files() {
    git ls-files --cached --others --exclude-standard -- "$@" ':!targets' | while IFS= read -r file; do
        [ -f "$file" ] && printf '%s\n' "$file"
    done
}

# report NAME FAULTS
report() {
    if [ -z "$2" ]; then
        echo "$1: OK"
    else
        printf '%s:\n%s\n' "$1" "$2"
        failed=1
    fi
}

# or_failure NAME COMMAND…: prints what the command prints if it fails, and never nothing then.
or_failure() {
    name=$1
    shift
    if ! output=$("$@" 2>&1); then
        printf '%s\n' "${output:-$name failed without a word}"
    fi
}

check_format() {
    project_files '*.c' '*.h' | or_failure clang-format xargs -d '\n' -r clang-format --dry-run -Werror
}

# The analysis of unchanged files is kept beside the library. Only one configuration is looked at:
# the one of the Makefile, on the C library's declarations that cppcheck brings along.
# internalAstError: cppcheck 2.10 gives up on &(type){value}, which is good C.
check_cppcheck() {
    analysed=$(dirname "$library")/cppcheck
    mkdir -p "$analysed"
    project_files 'src/*.c' 'tests/*.c' |
        or_failure cppcheck cppcheck --quiet --std=c11 --language=c --library=posix \
            --enable=warning,performance,portability --inline-suppr --error-exitcode=1 \
            --suppress=missingIncludeSystem --suppress=internalAstError \
            --template='{file}:{line}: {message} [{id}]' --cppcheck-build-dir="$analysed" \
            -j "$(nproc)" -Iinclude -Isrc -Itests -D_POSIX_C_SOURCE=200809L -D_XOPEN_SOURCE=700 --file-list=-
}

# What is linked with LAMMPS has a licence that goes with its own.
check_licence_lines() {
    project_files '*.c' '*.cpp' '*.h' '*.sh' '*.gp' Makefile .ci/run | while IFS= read -r file; do
        case $file in
        share/lammps/*) licence=GPL-2.0-or-later ;;
        *) licence=GPL-3.0-or-later ;;
        esac
        head -n 3 "$file" | grep -q "SPDX-License-Identifier: $licence" ||
            echo "$file: no SPDX line among the first three"
    done
}

# A file that does not fit into one reading has two subjects; so has a function of two screens.
check_lengths() {
    project_files 'src/*.c' 'src/*.h' 'include/*.h' | xargs -d '\n' -r awk -v longest_file=450 -v longest_function=60 '
        FNR == 1 {
            begin = 0
        }
        FNR == longest_file + 1 {
            print FILENAME ": more than " longest_file " lines"
        }
        /^[A-Za-z_]/ && !/^[a-z_]+:$/ {
            begin = FNR
        }
        /^}$/ && FNR - begin + 1 > longest_function {
            print FILENAME ":" begin ": a function of " FNR - begin + 1 " lines; " longest_function " are the most"
        }'
}

failed=0
report format "$(check_format)"
report cppcheck "$(check_cppcheck)"
tests/tools/check_layers.sh "$(dirname "$library")" || failed=1
tests/tools/check_names.sh $libraries || failed=1
tests/tools/check_docs.sh || failed=1
report licence "$(check_licence_lines)"
report lengths "$(check_lengths)"
exit $failed
