// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One point of a work-precision diagram: a scene with one integrator and one time step.
#pragma once

#include "observe/measure.h"
#include "observe/rdf.h"
#include "scene/scene.h"

enum { BENCH_METHOD_SIZE = 32 };

/// An integrator with its parameters.
struct bench_method {
    char name[BENCH_METHOD_SIZE]; ///< such as "dpd-verlet(0.65)"
    const struct integrator *integrator;
    const void *parameters; ///< NULL: the defaults; borrowed
};

enum { BENCH_MAX_METHODS = 16, BENCH_MAX_BINS = 4096 };

/// Whether integrators can be exchanged in a scene: its particles have velocities, and forces of
/// pairs. Fails: BAD_INPUT, saying what `bench` and this word want. Tested:
/// cli/test_bench_accuracy.
enum status mf_bench_point_check(const struct simulation_setup *setup, const char *scene,
                                 const char *word) MUST_USE;

/// Integrators that suit a scene: those with friction for a scene with ω, dpd-verlet with two λ
/// and, if the scene has them, with its inner steps, and those without for one without. Returns how
/// many. Tested: test_bench_point.
size_t mf_bench_methods(const struct simulation_setup *setup, struct bench_method *methods);

/// Those of the methods that a list such as "aboba,shardlow" names, by their own name or that of
/// their integrator; NULL lists all. Fails: BAD_INPUT if one of its names is none of them.
/// Tested: cli/test_bench_accuracy.
enum status mf_bench_methods_listed(const struct bench_method *methods, size_t count,
                                    const char *list, struct bench_method *listed,
                                    size_t *listed_count) MUST_USE;

/// The one that others are compared with: it has an error of order Δt² and an unbiased kinetic
/// temperature. Tested: test_bench_point.
const struct bench_method *mf_bench_reference_method(const struct bench_method *methods,
                                                     size_t count);

/// Bins of g(r) up to the cutoff of the forces. Those within a third of the mean distance hold few
/// pairs: they count as one.
struct bench_bins {
    struct rdf_bins fine;
    size_t core;  ///< fine bins that make up the first
    size_t count; ///< bins
};

/// Bins a tenth of the mean distance wide: 0.07 for the fluid of Groot and Warren.
/// Tested: test_bench_point.
struct bench_bins mf_bench_bins_choose(const struct box *box, size_t particles, double cutoff);

/// A mean or a difference with its standard error.
struct bench_number {
    double value, error;
};

enum bench_quantity {
    BENCH_TEMPERATURE,     ///< kinetic, where in a step the integrator keeps it unbiased [k_B T_0]
    BENCH_CONFIGURATIONAL, ///< temperature [k_B T_0]
    BENCH_ENERGY,          ///< potential, of a particle [k_B T_0]
    BENCH_PRESSURE,        ///< [k_B T_0/λ^d]
    BENCH_DIFFUSION,       ///< coefficient, of the MSD; NaN if a run is too short [λ²/τ]
    BENCH_TOTAL,           ///< energy of a particle [k_B T_0]
    BENCH_DRIFT,           ///< of the total energy of a particle [k_B T_0/τ]
    BENCH_QUANTITIES
};

struct bench_point {
    const struct bench_method *method;
    double time_step, time;  ///< Δt, length of the run after equilibration [τ]
    uint64_t seed, steps;    ///< of the noise; of the run
    uint64_t reported;       ///< steps that were reported to bench_common.report
    enum status status;      ///< OK or UNSTABLE
    struct bench_number cpu; ///< seconds of one processor per τ, without what is measured
    struct bench_number quantity[BENCH_QUANTITIES];
    struct bench_number *g; ///< shape [bins.count]
};

/// What all points of a scene share.
struct bench_common {
    const struct simulation_setup *setup;
    const struct simulation_start *start; ///< equilibrated; NULL: as the scene says
    struct bench_bins bins;
    /// Told after each sample how many steps more are done.
    void (*report)(void *context, uint64_t steps);
    void *context;
};

/// Steps that mf_bench_point_run will take, for progress.
uint64_t mf_bench_point_steps(const struct bench_common *common, const struct bench_point *point);

/// Run a point: equilibration of a twentieth of its time, then 20 blocks. The time of the processor
/// is that of the calling thread, over steps that nothing is measured in: the median of the blocks.
/// An unstable run is a result. Fails: BAD_INPUT, NO_MEMORY, INTERRUPTED.
enum status mf_bench_point_run(const struct bench_common *common,
                               struct bench_point *point) MUST_USE;

/// Equilibrate a scene for `time` with `method` and keep its positions and velocities in `values`,
/// shape [6, count]. Without ω velocities are scaled to the scene's temperature.
/// Fails: as mf_simulation_init and mf_simulation_run.
enum status mf_bench_point_prepare(const struct simulation_setup *setup,
                                   const struct simulation_start *start,
                                   const struct bench_method *method, double time_step, double time,
                                   double *values) MUST_USE;
