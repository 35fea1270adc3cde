// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One scene timed with one instruction set and one precision.
///
/// Timed is mf_simulation_run without sums, which is what fits spend their time in. Pairs are
/// counted between the timed parts. A scene without friction is brought to its temperature by
/// scaling velocities, since a lattice cools as it melts.
#pragma once

#include "report/run_folder.h"
#include "scene/scene.h"

#include <stdio.h>

enum {
    BENCH_REPEATS = 5,
    BENCH_NAME_SIZE = 128, ///< of a scene or a LAMMPS style
};

struct bench_scene {
    char name[BENCH_NAME_SIZE];
    struct scene scene;
};

/// Read a scene; what its file says of measurements is ignored. Clear scene->scene in any case.
/// @param[in] output   where results will go, or NULL
/// @param[in] options  the seed counts, if there is one
/// Fails: BAD_INPUT, also if the output would replace the scene or a file that it names; IO,
/// NO_MEMORY. Tested: test_bench_accuracy.
enum status mf_bench_scene_read(struct bench_scene *scene, const char *file, const char *output,
                                const struct run_options *options) MUST_USE;

/// How to run it.
struct bench_how {
    const char *isa;       ///< a name of mf_simd_select
    const char *precision; ///< "mixed" or "double"
    int threads;
    double seconds; ///< of one repeat, about
};

/// What came out. A number that there is nothing to measure for is not finite.
struct bench_result {
    char scene[BENCH_NAME_SIZE];
    const char *isa, *precision;
    double particles, threads, temperature;
    double pairs; ///< in range, mean
    double steps_per_second, steps_per_second_best, steps_per_second_spread;
    double particle_steps_per_second, pairs_per_second; ///< of the median, like all below
    double ns_per_pair;
    double ticks_per_pair; ///< of the time-stamp counter, whatever the clock of the core
    double phase_share[SIMULATION_PHASES];
    double list_efficiency; ///< pairs in range / pairs on the list
    double row_filling;     ///< pairs on the list / places in its rows
    double steps_per_build;
    char lammps_style[BENCH_NAME_SIZE]; ///< "" if there was no comparison, and then NaN below
    double lammps_steps_per_second, lammps_ratio;
};

/// A simulation being timed.
struct bench_case {
    struct simulation simulation;
    struct bench_how how;
    uint64_t steps;                                              ///< of a repeat
    uint64_t repeats;                                            ///< done
    uint64_t list_builds, ticks[SIMULATION_PHASES], ticks_total; ///< within the repeats
    double rate[BENCH_REPEATS];                                  ///< steps/s
    double busy_rate[BENCH_REPEATS];              ///< the same of this thread's processor time
    double seconds;                               ///< within the repeats
    double in_range, listed, places, temperature; ///< sums over samples
};

/// Middle of `count` values, or the mean of the two in the middle. count ≤ BENCH_REPEATS.
/// Tested: test_bench_case.
double mf_bench_median(const double *values, uint64_t count);

/// (largest − least) / median of the values. Tested: test_bench_case.
double mf_bench_spread(const double *values, uint64_t count);

/// Place the particles, equilibrate, and find out how many steps a repeat takes. The instruction
/// set must be there (mf_simd_select). Fails: as mf_simulation_init and mf_simulation_run.
enum status mf_bench_case_begin(struct bench_case *bench, const struct bench_scene *scene,
                                const struct bench_how *how) MUST_USE;

/// Time one repeat, at most BENCH_REPEATS in all, and count pairs.
enum status mf_bench_case_repeat(struct bench_case *bench) MUST_USE;

/// Results of the repeats so far. Tested: test_bench_case.
void mf_bench_case_result(const struct bench_case *bench, const char *scene,
                          struct bench_result *result);

void mf_bench_case_clear(struct bench_case *bench);

/// Time the scene as a fit runs it, and, in turn with it, with one part more or less: each part
/// that it has left out, each that it skips added. Print a line each, with the instruction set and
/// precision of `how`, and the standard error of what the part adds.
/// @param[in] table  for the same tab-separated, or NULL
/// Fails: as mf_bench_case_begin. Tested: test_bench_case, cli/test_bench.
enum status mf_bench_skips(FILE *out, FILE *table, const struct bench_scene *scene,
                           const struct bench_how *how) MUST_USE;

/// The line with the names of the table's columns.
void mf_bench_skips_head(FILE *table);
