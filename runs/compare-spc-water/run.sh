#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Fit water's potential by nine methods and put them side by side: runs/compare-spc-water/out/compare.
# Options of `mesofit fit` may follow, for example --seed 2.
set -eu
cd "$(dirname "$0")/../.."
here=runs/compare-spc-water
folders=
fit() {
    name=$1 file=$2
    shift 2
    # What has not converged is compared too.
    ./mesofit fit "$file" -o "$here/out/$name" "$@" || [ $? -eq 1 ]
    folders="$folders $here/out/$name"
}
for name in original genetic memetic cma-es nlopt; do
    fit $name $here/$name.json "$@"
done
for name in gauss-newton imc ibi hnc; do
    fit $name runs/spc-water-$name/run.json "$@"
done
# shellcheck disable=SC2086
./mesofit compare $folders -o $here/out/compare
