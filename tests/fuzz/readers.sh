#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# readers.sh HARNESS SECONDS: libFuzzer on every reader, beginning with the files of tests/fuzz/corpus
# and of earlier runs, which stay beside the harness with what it finds.
set -eu

place=$(dirname "$1")/corpus
mkdir -p "$place"

# add KIND FILE…: the first byte of an input says who reads it (fuzz_readers.c).
add() {
    kind=$1
    shift
    for file; do
        { printf '%s' "$kind" && cat "$file"; } >"$place/$kind-$(echo "$file" | tr / -)"
    done
}
cd "$(dirname "$0")/../.."
corpus=tests/fuzz/corpus
place=$(realpath "$place")
add t $corpus/*/*.tsv
add v $corpus/fit-votca/target.dist.tgt tests/reference_data/votca/*/*.dpot.imc
add s $corpus/*/scene.json
add r $corpus/*/run.json
add x tests/fuzz/trajectories/*
add l tests/fuzz/trajectories/*.d* tests/fuzz/trajectories/*.gsd tests/fuzz/trajectories/*.mol
add d tests/fuzz/trajectories/*.data tests/fuzz/trajectories/*.mol
add g tests/fuzz/trajectories/*.top tests/fuzz/trajectories/*.itp
printf 't# of LAMMPS\nAA\nN 3 R 1 3\n\n1 1 8 -1\n2 2 4 -2\n3 3 2 -3\n' >"$place/t-lammps-law"
printf 't# Row r g\n100 3\n1 1 0 0\n2 2 1 1\n3 3 1 2\n' >"$place/t-lammps-average"
printf 't"r / pm",U/kJ/mol,x (A)\n1,2,3\n2,3,4\n' >"$place/t-strokes"
printf 'm{"beads": {"A": {"residue": "B", "atoms": "C D"}, "E": {"first": 1, "last": 6, "size": 3}}, "masses": {"C": 1}}' >"$place/m-map"
printf 'w<cg_molecule><name>m</name><topology><cg_beads><cg_bead><name>a</name><type>A</type><mapping>w</mapping><beads>1:R:C 2:S:D</beads></cg_bead><cg_bead><name>b</name><type>A</type><mapping>w</mapping><beads>2:S:E 2:S:F</beads></cg_bead></cg_beads><cg_bonded><bond><name>s</name><beads>a b</beads></bond></cg_bonded></topology><maps><map><name>w</name><weights>1 2</weights></map></maps></cg_molecule>' >"$place/w-map"
printf 'i<cg><non-bonded><name>A-A</name><type1>A</type1><type2>A</type2><max>0.9</max><inverse><target>target.tsv</target><p_target>1</p_target><post_update>pressure</post_update></inverse></non-bonded><bonded><name>b</name><inverse><gromacs><table>table_b1.xvg</table></gromacs></inverse></bonded><inverse><kBT>2.5</kBT><filelist>beads.tsv</filelist></inverse></cg>' >"$place/i-settings"
printf 'cmesofit state 9' >"$place/c-head"
for kind in 1 2 3 4 5; do
    add $kind $corpus/fit/target.tsv $corpus/simulate/potential.tsv
done
printf '0{"status": "ok", "method": "imc", "seconds": 1.5, "rdf_rmse": 0.1, "pressure": null}' >"$place/0-summary"

[ -n "${TMPDIR:-}" ] || ! [ -w /dev/shm ] || export TMPDIR=/dev/shm # files by the ten thousand
report=$(mktemp)
trap 'rm -f "$report"' EXIT
status=0
ASAN_OPTIONS=allocator_may_return_null=1:max_allocation_size_mb=1024 \
    "$1" -max_total_time="$2" -timeout=20 -rss_limit_mb=4096 -malloc_limit_mb=1024 -max_len=16384 \
    -artifact_prefix="$(dirname "$place")/finding-" -print_final_stats=1 "$place" >"$report" 2>&1 ||
    status=$?
if [ $status -ne 0 ]; then
    tail -40 "$report"
    echo "readers: a finding, kept in $(dirname "$place")"
    exit 1
fi
echo "readers: $(sed -n 's/^stat::number_of_executed_units: *//p' "$report") files read in $2 s, no finding"
