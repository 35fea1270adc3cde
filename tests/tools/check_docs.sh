#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# check_docs.sh: what pages name is there. Links between files lead somewhere, also those to a section; the
# files that ARCHITECTURE.md names are there; the headers and citations of docs/theory.md are those of the
# sources; docs/fit.md quotes reasons that the program gives; user pages need no laboratory record; .ci/run
# does what the README's two commands do; packages are of this version; pages stay short. Run at the root of the source tree.
set -u
export LC_ALL=C.UTF-8

# All comments and texts of the sources in one line, without what begins lines and parts strings.
sources=$(cat src/*/*.[ch] | sed -e 's|^ *//[/!]*||' | tr '\n' ' ' | sed -e 's/" *"//g' -e 's/  */ /g')

# Cited where no header needs it: fluctuation and dissipation, and the uniqueness of a potential.
general='30, 191 (1995)|49, 197 (1974)'

# Names of the sections of a page, as links have them.
list_sections() {
    awk '/^```/ { code = !code } /^#+ / && !code' "$1" | sed -E 's/^#+ //; s/\]\([^)]*\)//g' |
        tr '[:upper:]' '[:lower:]' | sed -E 's/[^[:alnum:] _-]//g; s/ /-/g'
}

check_links() {
    local page link file section
    git ls-files --cached --others --exclude-standard '*.md' ':!targets' | while IFS= read -r page; do
        [ -e "$page" ] || continue
        grep -oE '\]\([^) ]+' "$page" | sed 's/^](//' | grep -v '^http' | while IFS= read -r link; do
            file=$page section=
            [ "${link%%#*}" = "" ] || file=$(dirname "$page")/${link%%#*}
            case $link in *.md#* | "#"*) section=${link#*#} ;; esac
            if [ ! -e "$file" ]; then
                echo "$page: no $link"
            elif [ -n "$section" ] && ! list_sections "$file" | grep -qxF -- "$section"; then
                echo "$page: no section $link"
            fi
        done
    done
}

# Files of src that ARCHITECTURE.md names, with or without what they end with.
check_modules() {
    local name
    grep -oE '`[a-z]+/[a-z_0-9]+(\.[chxt]+)?`' ARCHITECTURE.md | tr -d '`' | grep -vE '^(tests|src)/' |
        while IFS= read -r name; do
            compgen -G "src/$name" >/dev/null || compgen -G "src/$name.[ch]" >/dev/null ||
                echo "ARCHITECTURE.md: no src/$name"
        done
}

# What the README installs and runs, .ci/run installs and runs.
check_commands() {
    local package
    sed -n 's/.*apt-get install -y \([^&]*\)&&.*/\1/p' README.md | head -n 1 | tr ' ' '\n' | grep . |
        while IFS= read -r package; do
            grep -qw -- "$package" .ci/run || echo "README.md: .ci/run does not install $package"
        done
    grep -qx 'make test' README.md && grep -q '^run test ' .ci/run || echo "README.md, .ci/run: no make test"
}

# Whatever names the version names that of the header, and Debian's packages build with what the README installs
# but what only tests need, and so does the image.
check_packages() {
    local version package
    version=$(sed -n 's/^#define MESOFIT_VERSION "\(.*\)"/\1/p' include/mesofit.h)
    head -n 1 debian/changelog | grep -qF "($version)" || echo "debian/changelog: not of version $version"
    grep -qx "version: $version" CITATION.cff || echo "CITATION.cff: not of version $version"
    grep -qxF "{% set version = \"$version\" %}" packaging/conda/meta.yaml || echo "packaging/conda: not of version $version"
    sed -n 's/.*apt-get install -y \([^&]*\)&&.*/\1/p' README.md | head -n 1 | tr ' ' '\n' |
        grep -vxE '|build-essential|libcmocka-dev' | while IFS= read -r package; do
        sed '/^Package:/,$d' debian/control | grep -qw -- "$package" ||
            echo "debian/control: Build-Depends lacks $package"
        grep -qw -- "$package" Dockerfile || echo "Dockerfile: does not install $package"
    done
}

# check_length FILE MOST -w|-l: no more words or lines than that, as wc counts them.
check_length() {
    local length
    length=$(wc "$3" <"$1")
    [ "$length" -le "$2" ] || echo "$1: wc $3 says $length; $2 are enough"
}

# Texts in which the sources' own words are to be found.
check_quotes() {
    local quote
    while IFS= read -r quote; do
        grep -qF -- "$quote" <<<"$sources" || echo "$1: the sources do not have: $quote"
    done
}

list_reasons() {
    sed -n 's/^| "\([^…"]*[^…" ]\).*/\1/p' docs/fit.md
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
    check_modules
    list_reasons | check_quotes docs/fit.md
    list_citations | check_quotes docs/theory.md
    check_commands
    check_packages
    grep -nE '\]\(\.\./lab/' docs/*.md | sed 's/$/: a user needs no laboratory record/'
    check_length README.md 700 -w
    check_length docs/reference.md 10000 -w
    check_length ARCHITECTURE.md 2500 -w
    check_length CHANGELOG.md 100 -l
)
if [ -n "$faults" ]; then
    printf 'docs:\n%s\n' "$faults"
    exit 1
fi
echo 'docs: OK'
