// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Measure the g(r) of a potential by simulation: for fitness, and for verification.
#pragma once

#include "inverse/inverse.h"
#include "observe/measure.h"

/// How a potential is measured for its fitness.
struct evaluate_parameters {
    struct measure_plan plan;
    double temperature_tolerance; ///< largest |T/T_set − 1| at the end of the equilibration
    int estimator; ///< enum rdf_force_estimator; without a barrier (rdf_force_applies) the
                   ///< histogram
};

/// Result of one short simulation.
struct evaluate_result {
    double error;          ///< rms of g − g*
    double noise;          ///< rms expected from the statistical errors of both
    uint64_t engine_steps; ///< also when it failed
};

/// One simulation of the problem's scene with `potential`.
/// Fails: UNSTABLE if it blows up, leaves its temperature or collapses into a drop (which would
/// also be slow); INTERRUPTED; NO_MEMORY; BAD_INPUT as simulation_init.
enum status evaluate_potential(const struct inverse_problem *problem, const struct table *potential,
                               const struct evaluate_parameters *parameters, uint64_t seed,
                               struct evaluate_result *result) MUST_USE;

/// Verification of a result by independent replicas of a longer simulation.
struct evaluate_verification_parameters {
    int64_t replicas;
    double time_step; ///< 0: that of the scene [τ]
    struct measure_plan plan;
};

extern const struct field evaluate_verification_fields[];

struct evaluate_verification {
    size_t bins;
    double *g, *g_error; ///< shape [bins]
    double rmse, rmse_error, noise;
    struct thermodynamics_summary thermodynamics;
    uint64_t engine_steps;
};

/// Simulate the problem's scene with `potential` and new seeds; replicas in parallel.
/// Fails: as simulation_run.
enum status evaluate_verify(const struct inverse_problem *problem, const struct table *potential,
                            const struct evaluate_verification_parameters *parameters,
                            const struct inverse_listener *listener,
                            struct evaluate_verification *verification) MUST_USE;
void evaluate_verification_clear(struct evaluate_verification *verification);
