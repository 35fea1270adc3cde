// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Measure curves by simulation: for fitness, and for verification.
#pragma once

#include "problem/measurement.h"

/// How a candidate is measured for its fitness.
struct evaluate_parameters {
    struct measure_plan plan;
    double temperature_tolerance; ///< largest |T/T_set − 1| at the end of the equilibration
    int estimator; ///< of g(r), enum rdf_force_estimator; without a barrier (mf_rdf_force_applies)
                   ///< the histogram
    double racing; ///< standard errors by which a running error must be beyond `discard_above`
                   ///< before a simulation is stopped; 0: never
    double precision; ///< relative standard error of the error that is enough to stop; 0: never
};

/// One candidate.
struct evaluate_candidate {
    const struct table *potential, *omega;
    const double *const *position; ///< as in measurement_setup
    double discard_above;          ///< error with which the candidate cannot win
    int threads;                   ///< of its simulation
    uint64_t seed;
};

/// Why a simulation has no error.
enum evaluate_failure {
    EVALUATE_BLEW_UP,
    EVALUATE_TEMPERATURE, ///< off after equilibration
    EVALUATE_COLLAPSED,   ///< into a drop
    EVALUATE_UNMEASURED,  ///< it went well, and yet some target has no distance
    EVALUATE_FAILURES
};

/// Result of one short simulation.
struct evaluate_result {
    struct target_distance distance[TARGETS];
    double error;                  ///< mf_targets_error
    double noise;                  ///< expected from the statistical errors of both
    double variance;               ///< of the error
    bool stopped;                  ///< before its time
    enum evaluate_failure failure; ///< if there is no error
    double temperature;            ///< after equilibration over what it should be; 0: not reached
    uint64_t engine_steps;         ///< also when it failed
};

/// One simulation of the problem's scene.
/// @param[out] features  of what was measured, shape [mf_targets_features], or NULL
/// @param[out] observed  values and errors of all targets (mf_measurement_values_init), or NULL
/// @param[out] position  where the particles were at the end, shape [dimensions][count] by particle
///                       number, or NULL
/// Fails: UNSTABLE if it blows up, leaves its temperature or collapses into a drop (which would
/// also be slow); INTERRUPTED; NO_MEMORY; BAD_INPUT as mf_measurement_init.
enum status mf_evaluate(const struct inverse_problem *problem,
                        const struct evaluate_candidate *candidate,
                        const struct evaluate_parameters *parameters, double *features,
                        struct observed *observed, double *const *position,
                        struct evaluate_result *result) MUST_USE;

/// Equilibrations of a candidate that mf_evaluate_settle takes at least.
enum { EVALUATE_SETTLE = 24 };

/// A configuration from which all candidates may begin: the scene's own is a lattice, whose energy
/// heats the beads, and makes them move faster, for far longer than a candidate is equilibrated.
/// In windows, each twice as long as the last, until neither energy nor temperature drift
/// (observe/equilibration.h), two at least and six at most.
/// @param[in] equilibration  of a candidate [steps]: the first window is eight times as long
/// @param[out] position  shape [dimensions][count] by particle number
/// @param[in,out] steps  those taken are added
/// Fails: UNSTABLE as mf_evaluate, INTERRUPTED, NO_MEMORY. Tested: test_evaluate.
enum status mf_evaluate_settle(const struct inverse_problem *problem,
                               const struct evaluate_candidate *candidate, int64_t equilibration,
                               double *const *position, uint64_t *steps) MUST_USE;
