#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# check_threads.sh PROGRAM TEST…: pass tests and simulate with threads, all built for the thread
# sanitizer, with libomp in the place of libgomp and its tool archer: without them the sanitizer
# takes every meeting of threads for a race. Two threads that race in this script itself come first:
# a sanitizer that does not tell of them would tell of nothing.
set -eu
library=$(ls /usr/lib/llvm-*/lib/libomp.so.5 2>/dev/null | tail -n 1)
if [ -z "$library" ]; then
    echo "check_threads: no libomp: install libomp-dev" >&2
    exit 1
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "$1")
shift
ln -s "$library" "$folder/libgomp.so.1"

# With libomp, which is not to be linked to the compiler, too.
watch() {
    env LD_LIBRARY_PATH="$folder" OMP_TOOL_LIBRARIES="$(dirname "$library")/libarcher.so" \
        TSAN_OPTIONS="exitcode=66 halt_on_error=1 ignore_noninstrumented_modules=1" \
        KMP_BLOCKTIME=0 GOMP_SPINCOUNT=0 "$@"
}

cat >"$folder/race.c" <<'RACE'
int main(void) {
    static int sum, own[1000];
#pragma omp parallel for num_threads(2)
    for (int k = 0; k < 1000; k++)
        own[k] = k;
#pragma omp parallel for num_threads(2)
    for (int k = 0; k < 1000; k++)
        SHARED += own[999 - k];
    return sum < 0;
}
RACE
for shared in sum 'own[k]'; do
    ${CC:-gcc} -Og -fopenmp -fsanitize=thread -DSHARED="$shared" -o "$folder/race" "$folder/race.c"
    if watch "$folder/race" 2>/dev/null; then
        echo "a race of threads on $shared is not found" >&2
        exit 1
    fi
done
sed 's/SHARED += own\[999 - k\]/own[k] += k/' "$folder/race.c" >"$folder/good.c"
${CC:-gcc} -Og -fopenmp -fsanitize=thread -o "$folder/good" "$folder/good.c"
watch "$folder/good" || { echo "meetings of threads are taken for races" >&2; exit 1; }

for test in "$@"; do
    watch MESOFIT="$program" "$test"
done
for integrator in aboba aboba-implicit shardlow dpd-vv dpd-verlet lowe-andersen; do
    cat >"$folder/scene.json" <<SCENE
{"title": "threads", "seed": 1, "box": [10, 7, 7], "particles": {"count": 1500},
 "temperature": 1, "time_step": 0.02, "measure": {"equilibration": 20, "samples": 4, "every": 5},
 "motion": {"every": 1, "lags": 5}, "dynamics": {"integrator": "$integrator"},
 "conservative": {"law": "soft-repulsion", "a": 25}, "dissipative": {"law": "power", "sigma": 2.12}}
SCENE
    watch "$program" simulate "$folder/scene.json" -o "$folder/out" --threads 3 --quiet \
        >/dev/null 2>"$folder/words" ||
        { cat "$folder/words" >&2; exit 1; }
    echo "simulate, $integrator: no race"
done
