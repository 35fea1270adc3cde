#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The truth by LAMMPS (data.water, rdf_O-S.tsv), and the fit of what is unknown.
cd "$(dirname "$0")" || exit 1
set -e
python3 start.py
lmp -in in.truth -var steps 80000 -log truth.log >/dev/null
mesofit measure truth.lammpstrj --file-units real --range 0.78 --bins 39 --q-range 0 --static --temperature 300 -o truth --force
cp truth/rdf_1-3.tsv rdf_O-S.tsv
rm -r truth truth.lammpstrj truth.log data.lattice
mesofit fit run.json --engine lmp --force
