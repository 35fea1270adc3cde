#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# number.sh X.Y.Z: make it the release: in include/mesofit.h, of which all else has it, and in what others read:
# CITATION.cff, the recipe for conda-forge and debian/changelog, with today's date; CHANGELOG.md's "Unreleased" gets that heading.
set -eu
cd "$(dirname "$0")/.."

number=${1:-}
echo "$number" | grep -qxE '[0-9]+\.[0-9]+\.[0-9]+' || { echo "usage: make number NUMBER=X.Y.Z" >&2; exit 2; }
grep -qx '## Unreleased' CHANGELOG.md || { echo "CHANGELOG.md has no Unreleased" >&2; exit 1; }
today=$(date -u +%F)

sed -i "s/^#define MESOFIT_VERSION .*/#define MESOFIT_VERSION \"$number\"/" include/mesofit.h
sed -i "/^date-released:/d; s/^version: .*/version: $number\ndate-released: $today/" CITATION.cff
sed -i "s/^{% set version = .*/{% set version = \"$number\" %}/" packaging/conda/meta.yaml
sed -i "s/^## Unreleased\$/## $number - $today/" CHANGELOG.md
{
    printf 'mesofit (%s) unstable; urgency=medium\n\n  * Changes are in CHANGELOG.md.\n\n' "$number"
    printf ' -- The mesofit authors <mesofit@mesofit.example>  %s\n\n' "$(LC_ALL=C date -u +'%a, %d %b %Y 00:00:00 +0000')"
    cat debian/changelog
} >debian/changelog.partial
mv debian/changelog.partial debian/changelog
git diff --stat
