#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The truth by LAMMPS, its g(r) and density by measure, and the potential that has both.
cd "$(dirname "$0")" || exit 1
set -e
lmp -in in.truth -log truth.log >/dev/null
mesofit measure truth.lammpstrj --file-units lj --range 4 --bins 80 -o truth --force
# lj units are lambda, which measure calls nm
sed '1s/nm/lambda/' truth/rdf.tsv >rdf.tsv
grep density truth/summary.json # target.density of run.json
rm -r truth truth.lammpstrj truth.log
mesofit fit run.json --engine lmp --threads 2 --force
