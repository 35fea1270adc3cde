#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Water's potential from its g(r) by the inversions and by Gauss-Newton steps, side by side:
# runs/compare-inversions/out/compare. Options of `mesofit fit` may follow, for example --seed 2.
set -eu
cd "$(dirname "$0")/../.."
out=runs/compare-inversions/out
methods="imc ibi hnc auto gauss-newton"
for method in $methods; do
    ./mesofit fit "runs/spc-water-$method/run.json" -o "$out/$method" "$@"
done
./mesofit compare $(for method in $methods; do echo "$out/$method"; done) -o "$out/compare"
