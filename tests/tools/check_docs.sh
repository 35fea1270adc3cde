#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# check_docs.sh: what pages name is there. Links between files lead somewhere; the headers and citations of
# docs/theory.md are those of the sources; docs/converged.md quotes reasons that the program gives; the
# README stays short. Run at the root of the source tree.
set -u
export LC_ALL=C.UTF-8

# All comments and texts of the sources in one line, without what begins lines and parts strings.
sources=$(cat src/*/*.[ch] | sed -e 's|^ *//[/!]*||' | tr '\n' ' ' | sed -e 's/" *"//g' -e 's/  */ /g')

# Cited where no header needs it: fluctuation and dissipation, and the uniqueness of a potential.
general='30, 191 (1995)|49, 197 (1974)'

check_links() {
    local page link
    git ls-files --cached --others --exclude-standard '*.md' ':!targets' | while IFS= read -r page; do
        grep -oE '\]\([^)#]+' "$page" | sed 's/^](//' | grep -v '^http' | while IFS= read -r link; do
            [ -e "$(dirname "$page")/$link" ] || echo "$page: no $link"
        done
    done
}

# Texts in which the sources' own words are to be found.
check_quotes() {
    local quote
    while IFS= read -r quote; do
        grep -qF -- "$quote" <<<"$sources" || echo "$1: the sources do not have: $quote"
    done
}

list_reasons() {
    sed -n 's/^| "\([^…"]*[^…" ]\).*/\1/p' docs/converged.md
}

list_citations() {
    tr '\n' ' ' <docs/theory.md | grep -oE '[A-Z]?[0-9]+, [A-Z]?[0-9]+ \([0-9]{4}\)' | grep -vE -- "${general//[()]/.}"
}

check_headers() {
    local header
    grep -oE '`[a-z_]+/[a-z_0-9]+\.h`' docs/theory.md | tr -d '`' | while IFS= read -r header; do
        [ -e "src/$header" ] || echo "docs/theory.md: no src/$header"
    done
}

faults=$(
    check_links
    check_headers
    list_reasons | check_quotes docs/converged.md
    list_citations | check_quotes docs/theory.md
    words=$(wc -w <README.md)
    [ "$words" -le 900 ] || echo "README.md: $words words; 900 are enough"
)
if [ -n "$faults" ]; then
    printf 'docs:\n%s\n' "$faults"
    exit 1
fi
echo 'docs: OK'
