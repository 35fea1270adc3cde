#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# The targets of the repository with the shortest run files, beside the run files made by hand. Prints
# a row for each fit and seed (lab/default-fits.md).
#
# tests/bench/default_fits.sh [PROGRAM] [FOLDER]
# SEEDS="1 2 3" and RUNS="lennard-jones …" pick some. What FOLDER holds already is not run again.
set -eu
export LC_ALL=C.UTF-8
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${1:-$root/build/mesofit}")
folder=${2:-$(mktemp -d)}
seeds=${SEEDS:-1 2 3}
runs=${RUNS:-soft-discs gaussian-core lennard-jones spc-water spce-votca lennard-jones-mixture spc-water-omega twin-omega}
export OMP_WAIT_POLICY=passive
mkdir -p "$folder"
targets=$root/targets
water="$targets/spc-water"

# $1 name: what its shortest run file says, and the run file made by hand.
describe() {
    rdf_of_water="\"rdf\": {\"file\": \"$water/spc298_rdf_com_1.0nm_100.txt\", \"r_column\": 4,
        \"g_column\": 5, \"error_column\": 6, \"particles\": 2744}"
    unknowns=
    case $1 in
    soft-discs)
        by_hand=soft-discs-fit
        target="\"rdf\": {\"file\": \"$targets/$1/rdf.tsv\", \"particles\": 1600}"
        scene='"dimensions": 2, "density": 0.8'
        ;;
    gaussian-core)
        by_hand=gaussian-core-imc
        target="\"rdf\": {\"file\": \"$targets/$1/rdf.tsv\", \"particles\": 1728}"
        scene='"density": 0.2499533'
        ;;
    lennard-jones)
        by_hand=lennard-jones-imc
        target="\"rdf\": {\"file\": \"$targets/$1/rdf.tsv\", \"particles\": 1382}"
        scene='"density": 0.8'
        ;;
    spc-water)
        by_hand=spc-water-auto
        target=$rdf_of_water
        scene='"density": 3.274377'
        ;;
    spce-votca)
        by_hand=spce-votca
        target="\"rdf\": {\"file\": \"$targets/$1/CG-CG.dist.tgt\", \"format\": \"votca\"}"
        scene='"box": [8.668817, 8.668817, 8.668817], "particles": {"count": 2180},
            "units": {"length": 0.465, "temperature": 300, "mass": 2.992e-26}'
        ;;
    lennard-jones-mixture)
        by_hand=lennard-jones-mixture-imc
        target="\"rdf\": {\"A-A\": {\"file\": \"$targets/$1/rdf_A-A.tsv\"},
            \"A-B\": {\"file\": \"$targets/$1/rdf_A-B.tsv\"}, \"B-B\": {\"file\": \"$targets/$1/rdf_B-B.tsv\"}},
            \"pressure\": {\"value\": 1.5231, \"error\": 0.0031}"
        scene='"box": [11.8, 11.8, 11.8], "particles": {"types": {"A": 700, "B": 700}}, "temperature": 1.2'
        ;;
    spc-water-omega)
        by_hand=spc-water-omega-gauss-newton
        target="$rdf_of_water, \"etd\": {\"file\": \"$water/spc298_etd_E.txt\",
            \"error_file\": \"$water/spc298_etd_se.txt\", \"time_column\": 2, \"first_column\": 3,
            \"r_minimum\": 0.5376344, \"r_maximum\": 1.0752688},
            \"diffusion\": {\"fitted\": \"no\", \"value\": 0.0245, \"error\": 0.0002}"
        scene='"density": 3.274377'
        ;;
    twin-omega) # its README says why the time step must be that of the target
        by_hand=twin-omega
        target="\"etd\": {\"file\": \"$targets/$1/etd.tsv\", \"error_file\": \"$targets/$1/etd_error.tsv\"}"
        scene="\"density\": 3.274377, \"time_step\": 0.008, \"conservative\": {\"law\": \"table\",
            \"file\": \"$water/potential_imc.tsv\", \"cutoff\": 2.1505373737373734}"
        unknowns='"unknowns": {"omega": {"truth": {"law": "power", "sigma": 6, "exponent": 2,
            "inner_cutoff": 0.596, "cutoff": 1.72}}},'
        ;;
    esac
}

# $1 summary.json, $2 key: its number, or "-".
number() {
    sed -n "s/^[[:space:]]*\"$2\":[[:space:]]*\([-0-9.e+]*\),*$/\1/p" "$1" | head -n 1 | grep . || echo -
}

# $1 run file, $2 folder of the result, $3 seed, $4 name: fit it, and one row.
row() {
    [ -e "$2/summary.json" ] ||
        /usr/bin/time -f %U -o "$2.seconds" "$program" fit "$1" -o "$2" --seed "$3" --threads 2 --quiet || true
    printf '%s\t%s\t%s' "$4" "$3" "$(tail -n 1 "$2.seconds")"
    for key in rdf_rmse rdf_rmse_error rdf_noise etd_rmse etd_noise diffusion pressure temperature \
        temperature_configurational; do
        printf '\t%s' "$(number "$2/summary.json" $key)"
    done
    printf '\n'
}

printf '# run\tseed\tprocessor_s\trdf_rmse\terror\tnoise\tetd_rmse\tnoise\tD\tP\tT\tT_c\n'
for name in $runs; do
    describe "$name"
    printf '{"target": {%s}, %s "scene": {%s}}\n' "$target" "$unknowns" "$scene" >"$folder/$name.json"
    for seed in $seeds; do
        row "$root/runs/$by_hand/run.json" "$folder/$name-hand-$seed" "$seed" "$name by hand"
        row "$folder/$name.json" "$folder/$name-$seed" "$seed" "$name"
    done
done
