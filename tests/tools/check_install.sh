#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# check_install.sh PREFIX BUILD: what was installed is whole. Every example is built against it, by
# pkg-config alone, and run; the headers are good C++; the shared library shows no name but its own;
# the program draws figures from anywhere, also where the package has been moved; its man page and its
# completions are there. Run at the root of the source tree.
set -eu
export LC_ALL=C.UTF-8

prefix=$1
build=$2
place=$(realpath "$2")/examples
root=$(pwd)
export PKG_CONFIG_PATH="$prefix/lib/pkgconfig" LD_LIBRARY_PATH="$prefix/lib"
export OMP_WAIT_POLICY=passive
rm -rf "$place"
mkdir -p "$place"

foreign=$(nm -D --defined-only "$prefix/lib/libmesofit.so" | awk '$3 !~ /^mesofit_/ {print $3}')
[ -z "$foreign" ] || { echo "libmesofit.so shows: $foreign"; exit 1; }

# shellcheck disable=SC2046
for example in examples/*.c; do
    name=$(basename "$example" .c)
    ${CC:-cc} -std=c11 -Wall -Wextra -Werror -o "$place/$name" "$example" \
        $(pkg-config --cflags --libs mesofit) -lm
done

for header in mesofit.h $(cd include && ls mesofit/*.h); do
    printf '#include <%s>\nint main() { return 0; }\n' "$header" >"$place/header.cpp"
    g++ -std=c++11 -Wall -Wextra -Werror -fsyntax-only $(pkg-config --cflags mesofit) "$place/header.cpp"
done

cd "$place"
grep -v '^#' "$root/targets/spc-water/spc298_rdf_com_1.0nm_100.txt" | awk '{print $4, $5, $6}' >water.txt
./rdf >rdf.txt
./own_force >own_force.txt
./fit_water <water.txt >potential.txt 2>fit_water.txt
./own_optimiser "$root/examples/potential.json" >own_optimiser.txt
./fit_friction "$root/examples/friction.json" >omega.txt 2>fit_friction.txt
for output in rdf.txt own_force.txt potential.txt own_optimiser.txt omega.txt; do
    [ -s "$output" ] || { echo "an example printed nothing: $output"; exit 1; }
done

# A folder that is neither that of the sources nor that of the package, which DESTDIR has put elsewhere.
moved=$(mktemp -d)
trap 'rm -rf "$moved"' EXIT
make -s -C "$root" CC="${CC:-cc}" BUILD="$build" DESTDIR="$moved/root" PREFIX=/usr install >/dev/null
cd "$moved"
cat >scene.json <<'END'
{"box": [3, 3, 3], "particles": {"count": 81}, "conservative": {"law": "soft-repulsion"},
 "dissipative": {"law": "power", "sigma": 3}, "measure": {"samples": 20, "every": 5}, "rdf": {"range": 1}}
END
for program in "$prefix/bin/mesofit" "$moved/root/usr/bin/mesofit"; do
    "$program" --version >/dev/null
    "$program" simulate scene.json -o run --quiet >/dev/null
    rm -rf run/figures
    "$program" plot run
    [ -s run/figures/simulation.png ] || { echo "$program draws no figure"; exit 1; }
done
for place in "$prefix" "$moved/root/usr"; do
    [ -s "$place/share/mesofit/lammps/pair_mesofit_table.cpp" ] || { echo "$place: no pair style for LAMMPS"; exit 1; }
    head -n 1 "$place/share/man/man1/mesofit.1" | grep -q '^\.TH MESOFIT 1 ' || { echo "$place: no man page"; exit 1; }
    bash -c ". '$place/share/bash-completion/completions/mesofit'; complete -p mesofit" >/dev/null
done
echo "examples: OK"
echo "installed program: OK"
