#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# check_mpi.sh WITHOUT PROGRAM KILLS: a short fit of each method has the same bits in one process,
# WITHOUT MPI, and among ranks of PROGRAM; it goes on with another layout after it was stopped or a
# rank was killed, KILLS times; and what is wrong is said. METHODS="imc genetic" checks these alone.
set -u
export LC_ALL=C.UTF-8
without=$(realpath "$1")
program=$2
kills=$3
if ! command -v mpirun >/dev/null || [ ! -x "$program" ]; then
    echo "check_mpi: skipped: there is no MPI (Debian: libopenmpi-dev and openmpi-bin)"
    exit 0
fi
program=$(realpath "$program")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failed=0
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# No gnuplot: figures are not looked at.
export PATH="$folder/bin:$PATH"
mkdir bin
ln -s /bin/false bin/gnuplot

# ranks NUMBER WORD…: a command among ranks; the words of mpirun about exit codes say nothing new.
ranks() {
    local number=$1
    shift
    mpirun --bind-to none -np "$number" "$@" 2>words
}

# sums FOLDER: digests of all that a fit leaves but for what tells times.
sums() {
    for file in "$1"/*.tsv "$1"/states/*/*.tsv "$1"/*.json "$1"/*.pot "$1"/*.tex; do
        case $file in
        */timing.tsv | */tasks.tsv | *\**) ;;
        *) printf '%s %s\n' "${file##*/}" "$(grep -v '"seconds"\|"threads"' "$file" | sha256sum)" ;;
        esac
    done
}

# same NAME ONE OTHER
same() {
    if [ -s "$2/summary.json" ] && [ "$(sums "$2")" = "$(sums "$3")" ]; then
        echo "$1: the same bits"
    else
        echo "$1: other bits than in one process:"
        diff <(sums "$2") <(sums "$3")
        failed=1
    fi
}

# expect NAME PATTERN: what the last command has said.
expect() {
    if grep -q -- "$2" words; then
        echo "$1: $(grep -m 1 -o -- "$2.*" words | cut -c 1-100)"
    else
        echo "$1: \"$2\" was not said, but:"
        cat words
        failed=1
    fi
}

cat >scene.json <<'SCENE'
{"seed": 3, "box": [4, 4, 4], "particles": {"count": 192}, "temperature": 1, "time_step": 0.01,
 "conservative": {"law": "soft-repulsion", "a": 25}, "dissipative": {"law": "power", "sigma": 3},
 "rdf": {"bins": 30}, "etd": {"r_minimum": 0.4, "r_maximum": 1, "bins": 10, "times": 21, "every": 2},
 "motion": {"every": 2, "lags": 50}, "measure": {"equilibration": 500, "samples": 400, "every": 10}}
SCENE
"$without" simulate scene.json -o twin --quiet 2>words || exit 1

# run NAME TARGETS UNKNOWNS METHOD: a run file.
run() {
    known='"conservative": {"law": "soft-repulsion", "a": 25},'
    weight='"dissipative": {"law": "power", "sigma": 3},'
    case $3 in *potential*) known= ;; esac
    case $3 in *omega*) weight= ;; esac
    cat >"$1.json" <<RUN
{"seed": 1, "target": {$2}, "unknowns": {$3},
 "scene": {"box": [4, 4, 4], "particles": {"count": 192}, $known $weight "time_step": 0.01},
 "method": {$4},
 "verification": {"replicas": 5, "equilibration": 40, "samples": 30, "every": 10}}
RUN
    methods="$methods $1"
}
methods=
rdf='"rdf": {"file": "twin/rdf.tsv"}'
etd='"etd": {"file": "twin/etd.tsv", "error_file": "twin/etd_error.tsv"}'
moves='"diffusion": {"fitted": "no", "value": 0.3, "error": 0.1}, "vacf": {"fitted": "no", "file": "twin/motion.tsv"}'
potential='"potential": {"coefficients": 5, "minimum": -2, "maximum": 15}'
omega='"omega": {"coefficients": 4, "minimum": 0, "maximum": 8, "cutoff": 1}'
# Long enough that samples are doubled.
sampled='"replicas": 5, "equilibration": 100, "samples": 8, "every": 1, "iterations": 12'
simulated='"equilibration": 40, "samples": 10, "every": 10, "temperature_tolerance": 0.5'
run imc "$rdf" '"potential": {}' "\"name\": \"imc\", $sampled"
run imc-dynamics "$rdf" '"potential": {}' "\"name\": \"imc\", \"sampler\": \"dynamics\", $sampled"
run ibi "$rdf" '"potential": {}' "\"name\": \"ibi\", $sampled"
run hnc "$rdf" '"potential": {}' "\"name\": \"hnc\", $sampled"
run relative-entropy "$rdf" '"potential": {}' "\"name\": \"relative-entropy\", \"coefficients\": 8, $sampled"
run auto "$rdf" '"potential": {}' "\"name\": \"auto\", $sampled"
sed 's/"count": 192/"count": 128/; s/"seed": 3/"seed": 5/' scene.json >dilute.json
"$without" simulate dilute.json -o dilute --quiet 2>words || exit 1
run states "$rdf" '"potential": {}' "\"name\": \"imc\", $sampled"
sed -i 's|"method"|"states": {"dense": {}, "dilute": {"scene": {"particles": {"count": 128}},\
  "target": {"rdf": {"file": "dilute/rdf.tsv"}}}}, "method"|' states.json
run genetic "$rdf" "$potential" "\"name\": \"genetic\", \"population\": 12, \"generations\": 4, \"racing\": 2, \"warm_start\": \"yes\", $simulated"
run cma-es "$rdf, $etd, $moves" "$potential, $omega" "\"name\": \"cma-es\", \"rounds\": 4, $simulated"
run nlopt "$rdf" "$potential" "\"name\": \"nlopt\", \"evaluations\": 12, $simulated"
run gauss-newton "$etd, $moves" "$omega" "\"name\": \"gauss-newton\", \"iterations\": 4, $simulated"
run pareto "$rdf, $etd" "$potential, $omega" "\"name\": \"pareto\", \"population\": 12, \"generations\": 3, $simulated"
run formulas "$rdf" '"potential": {}' "\"name\": \"formulas\", \"nodes\": 8, \"children\": 60, \"islands\": 3, \"curve_particles\": 192, \"curve_precision\": 0.02, \"checks\": 2, $simulated"
run successive "$rdf, $etd" "\"potential\": {}, $omega" "\"name\": \"successive\", \"potential_precision\": 0.02, $simulated"

# Trimers: pairs, bonds and angles at once.
chain='"molecules": {"trimer": {"count": 40, "chain": {"type": "A", "length": 3, "bond": "rod", "angle": "bend"}}}'
laws='"bonds": {"rod": {"law": "harmonic", "k": 200, "length": 0.6}}, "angles": {"bend": {"law": "harmonic", "k": 20, "angle": 110}}'
sed "s/\"particles\": {\"count\": 192}/$laws, $chain/; s/\"etd\".*/\"bond_lengths\": {\"bins\": 40}, \"bond_angles\": {\"bins\": 40},/; s/\"motion\": {.*}, //; s/0.01,/0.005,/" \
    scene.json >trimers.json
"$without" simulate trimers.json -o trimers --quiet 2>words || cat words
groups='"bond_lengths": {"rod": {"file": "trimers/bond_lengths.tsv"}}, "bond_angles": {"bend": {"file": "trimers/bond_angles.tsv"}}'
for name in imc states; do
    run $name-molecules '"rdf": {"file": "trimers/rdf.tsv"}, '"$groups" '"potential": {}' "\"name\": \"imc\", ${sampled/12/6}"
    sed -i "s/\"particles\": {\"count\": 192}/$chain/" $name-molecules.json
done
sed -i 's|"method"|"states": {"cold": {"scene": {"temperature": 0.9}}, "warm": {"scene": {"temperature": 1}}}, "method"|' states-molecules.json

for method in ${METHODS-$methods}; do
    "$without" fit "$method.json" -o "$method" --quiet --threads 1 2>words
    [ -s "$method/summary.json" ] || cat words
    layouts="4x1 3x2 1x4"
    case $method in imc | genetic) layouts="$layouts 8x1 1x8" ;; esac
    for layout in $layouts; do
        ranks "${layout%x*}" "$program" fit "$method.json" -o "$method-$layout" --quiet --threads "${layout#*x}"
        same "$method, ${layout%x*} ranks of ${layout#*x} threads" "$method" "$method-$layout"
    done
done

# A fit of some seconds.
run long "$rdf" "$potential" "\"name\": \"genetic\", \"population\": 30, \"generations\": 12, \"warm_start\": \"yes\", \"surrogate\": \"no\", $simulated"
"$without" fit long.json -o long --quiet --threads 2 2>words
[ -s long/summary.json ] || cat words

# begun FOLDER: wait until a fit has written its first iteration there.
begun() {
    until [ -e "$1/history.tsv" ]; do sleep 0.02; done
}

# ranks_of COMMAND: process numbers of the ranks that run it.
ranks_of() {
    pgrep -f "$1" | while read -r process; do
        [ "$(readlink "/proc/$process/exe")" = "$program" ] && echo "$process"
    done
}

# A rank is killed at some moment: the job ends, its checkpoint is whole, and another layout goes on.
for kill in $(seq "$kills"); do
    rm -rf killed
    ranks 3 "$program" fit long.json -o killed --quiet --threads 1 &
    job=$!
    until [ -e killed/checkpoint.bin ]; do sleep 0.01; done
    sleep "0.$((RANDOM % 90 + 10))"
    mapfile -t processes < <(ranks_of "$program fit long.json -o killed")
    if [ ${#processes[@]} -gt 0 ]; then
        kill -KILL "${processes[RANDOM % ${#processes[@]}]}"
    fi
    wait "$job"
    case $((kill % 3)) in
    0) "$without" fit long.json -o killed --quiet --resume --threads 2 2>words ;;
    1) ranks 2 "$program" fit long.json -o killed --quiet --resume --threads 1 ;;
    2) ranks 4 "$program" fit long.json -o killed --quiet --resume --threads 1 ;;
    esac
    same "kill -KILL of a rank, $kill of $kills" long killed
done

# The end of a job's time: all ranks stop together, and that is no failure.
for signal in USR1 TERM INT; do
    rm -rf stopped
    ranks 3 "$program" fit long.json -o stopped --quiet --threads 1 &
    job=$!
    begun stopped
    kill -"$signal" "$(ranks_of "$program fit long.json -o stopped" | tail -1)"
    wait "$job"
    code=$?
    expect "SIG$signal of one rank" "interrupted after"
    [ $code = "$([ $signal = INT ] && echo 130 || echo 0)" ] || {
        echo "SIG$signal: exit code $code"
        failed=1
    }
    grep -q '"interrupted"' stopped/summary.json || {
        echo "SIG$signal: the summary does not say so"
        failed=1
    }
    "$without" fit long.json -o stopped --quiet --resume --threads 2 2>words
    same "resumed after SIG$signal" long stopped
done

# What is wrong is said once, by rank 0 or with the rank's name, and all end.
ranks 3 "$program" fit missing.json -o nowhere
expect "a run file that is not there" "mesofit: missing.json: No such file"
[ "$(grep -c "missing.json" words)" = 1 ] || failed=1
ranks 3 "$without" fit long.json -o nowhere
expect "a program without MPI" "built without MPI"
[ "$(grep -c "built without MPI" words)" = 1 ] || failed=1
ranks 3 "$program" fit long.json -o long --quiet
expect "a folder that holds a fit" "mesofit: long holds a finished fit"
sed 's/"seed": 1/"seed": 2/' long.json >other.json
ranks 3 bash -c 'exec "$0" fit $([ $OMPI_COMM_WORLD_RANK = 2 ] && echo other.json || echo long.json) -o mixed --quiet' "$program"
expect "a rank with another input" "rank 2 on .* has computed other numbers"
ranks 2 "$program" fit long.json -o live --live
expect "the live view among ranks" "--live is for a fit in one process"

[ $failed = 0 ] && echo "check_mpi: OK"
exit $failed
