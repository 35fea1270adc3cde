// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What `mesofit bench` measures: the speed of the engine, what time steps cost and spoil,
/// which of them are stable, how soon samplers know g(r).
#pragma once

#include "report/run_folder.h"

#include <stddef.h>

struct bench_options {
    const char *isa, *precision; ///< the only one to be timed; NULL: all there are
    const char *output;          ///< a TSV file, or NULL
    const char *seconds;         ///< of a repeat, or NULL: long enough
    bool json;                   ///< instead of tables for people
    bool against_lammps;         ///< compare with LAMMPS; the best instruction set alone
    bool skips;                  ///< what each part of a step costs; the best instruction set alone
};

/// `bench engine`, the speed of scenes with every instruction set and precision: time those in
/// `files`, or those that ship with the program if there are none, and print
/// the results to stdout. What a scene file says of measurements is ignored.
/// @param[in] common  threads, seed and quiet count
/// Fails: BAD_INPUT, IO, NO_MEMORY; UNSTABLE; INTERRUPTED, and nothing is kept.
enum status mf_bench_engine(const char *const *files, size_t count,
                            const struct run_options *common,
                            const struct bench_options *options) MUST_USE;

struct bench_accuracy_options {
    const char *output;     ///< a TSV file, which figures are drawn of beside it, or NULL
    const char *error;      ///< |Δg| that is wanted, or NULL: 0.005
    const char *time;       ///< of a point [τ], or NULL: by the scene
    const char *time_steps; ///< "0.01,0.02", growing [τ], or NULL: from a quarter of the scene's on
    const char *integrators; ///< "aboba,shardlow", or NULL: all that suit
    bool json;               ///< instead of tables for people
};

/// `bench accuracy`, the work-precision diagram of a scene: run it with every integrator that
/// suits, at time steps that grow until one is unstable, and print what each costs and spoils. The
/// simulations run side by side, one a thread; all results but the seconds are the same for any
/// number of threads.
/// @param[in] common  threads, seed and quiet count
/// Fails: BAD_INPUT, IO, NO_MEMORY; UNSTABLE if the reference is; INTERRUPTED, and nothing is kept.
/// Tested: tests/cli/test_bench_accuracy.c.
enum status mf_bench_accuracy(const char *file, const struct run_options *common,
                              const struct bench_accuracy_options *options) MUST_USE;

struct bench_stability_options {
    const char *output;      ///< a TSV file, which a figure is drawn of beside it, or NULL
    const char *time;        ///< of a run [τ], or NULL: 5
    const char *integrators; ///< "aboba,shardlow", or NULL: all that suit
};

/// `bench stability`, which time step goes with which friction and which stiffness: run a scene
/// with every integrator that suits it at time steps from a sixteenth of its own to five times
/// that, with friction ω² from a quarter to 256 times, and with potentials from a quarter to 64
/// times as strong as it says, and print how far both temperatures are off, and where runs end as
/// unstable. The same for any number of threads.
/// @param[in] file  a scene, or NULL: the fluid of Groot and Warren, 375 beads
/// Fails: BAD_INPUT, IO, NO_MEMORY, INTERRUPTED. Tested: cli/test_bench_stability.
enum status mf_bench_stability(const char *file, const struct run_options *common,
                               const struct bench_stability_options *options) MUST_USE;

/// `bench samplers`, how soon each sampler of the inversions knows g(r): print, for the scene's
/// potential at its density and temperature, what the error of g (rms over
/// bins) times the square root of the processor time is, for every sampler, with 729 and with 2744
/// particles. Fails: BAD_INPUT (no potential), IO, NO_MEMORY, INTERRUPTED. Tested: test_bench.
enum status mf_bench_samplers(const char *file, const struct run_options *common) MUST_USE;
