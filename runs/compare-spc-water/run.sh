#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Fit water's potential by five methods and put them side by side: runs/compare-spc-water/out/compare.
# Options of `mesofit fit` may follow, for example --seed 2.
set -eu
cd "$(dirname "$0")/../.."
here=runs/compare-spc-water
for method in genetic nlopt cma-es; do
    ./mesofit fit $here/$method.json -o $here/out/$method "$@"
done
for method in gauss-newton imc; do
    ./mesofit fit runs/spc-water-$method/run.json -o $here/out/$method "$@"
done
./mesofit compare $here/out/genetic $here/out/nlopt $here/out/cma-es $here/out/gauss-newton \
    $here/out/imc -o $here/out/compare
