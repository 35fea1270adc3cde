// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The observables of one simulation that the targets of a fit ask for.
#pragma once

#include "problem/inverse.h"
#include "observe/measure.h"

struct measurement {
    const struct targets *targets; ///< borrowed
    struct simulation simulation;
    struct observable_use use[OBSERVABLES_MAX + 1];
};

/// What a simulation is to have.
struct measurement_setup {
    const struct targets *targets;         ///< to be observed; borrowed
    const struct table *potential, *omega; ///< borrowed
    const double *const
        *position;    ///< shape [dimensions][count] to begin with, or NULL: as the scene
    double time_step; ///< 0: that of the scene [τ]
    struct measure_plan plan;
    bool force_estimator; ///< of g(r), where it applies
    bool thermodynamics;  ///< also if no target needs it
    int threads;
    uint64_t seed;
};

/// List the observables that `setup` asks for with their settings, in simulations with steps of
/// `time_step` [τ]; none has a state yet. `uses` must be cleared, also after a failure.
/// @param[out] uses  shape [OBSERVABLES_MAX + 1]
/// Fails: NO_MEMORY.
enum status mf_measurement_list(const struct measurement_setup *setup, double time_step,
                                struct observable_use *uses) MUST_USE;
void mf_measurement_list_clear(struct observable_use *uses);

/// Steps of the longest window of what is asked for, and the target that it belongs to: a plan must
/// have as many after its equilibration. 0 if nothing has a window.
int64_t mf_measurement_window(const struct targets *targets, double time_step,
                              enum target_kind *longest);

/// Begin the simulation, at step 0. Must be cleared, also after a failure.
/// Fails: as mf_simulation_init; BAD_INPUT if the plan is shorter than the window of a target.
enum status mf_measurement_init(struct measurement *measurement,
                                const struct inverse_problem *problem,
                                const struct measurement_setup *setup) MUST_USE;
void mf_measurement_clear(struct measurement *measurement);

/// What the observables have seen, and where the particles are: all of a measurement that results
/// need, but for the simulation's next step. Room is made for it; 0 if there is no memory.
/// @return the number of spans
size_t mf_measurement_spans(struct measurement *measurement, struct memory_span *spans);

/// State of an observable; NULL if it is not measured.
const void *mf_measurement_state(const struct measurement *measurement,
                                 const struct observable *observable);

/// Values and errors of all targets, one after the other: shape [targets_values]. Their spans are
/// at most 2 × TARGETS.
struct observed {
    double *value[TARGETS], *error[TARGETS]; ///< shape [target.count], NaN: not measured
    double freedom[TARGETS]; ///< degrees of freedom of the errors, at most; 0: not told
};
enum status mf_measurement_values_init(struct observed *observed,
                                       const struct targets *targets) MUST_USE;
size_t mf_measurement_values_spans(const struct observed *observed, const struct targets *targets,
                                   struct memory_span *spans);
void mf_measurement_values_clear(struct observed *observed);

/// Results of replicas together. Fails: NO_MEMORY.
enum status mf_measurement_result(const struct measurement *replicas, size_t count,
                                  struct observed *observed) MUST_USE;

/// Mean of independent simulations as long as each other; what one has not seen is the mean of the
/// others. Where they know no errors, as after one window of time, the mean has those of their
/// scatter.
void mf_measurement_mean(const struct observed *observed, size_t count,
                         const struct targets *targets, struct observed *mean);

/// Distances of what was observed from all targets.
void mf_measurement_distance(const struct observed *observed, const struct targets *targets,
                             struct target_distance distance[TARGETS]);
