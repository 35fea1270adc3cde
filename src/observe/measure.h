// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Equilibrate a simulation, then step it and feed its observables.
#pragma once

#include "observe/observable.h"

/// When to sample. All in steps, so that nothing is rounded.
struct measure_plan {
    int64_t equilibration; ///< steps before the first sample
    int64_t samples;
    int64_t every; ///< steps between samples
};

extern const struct field mf_measure_plan_fields[];

/// Steps of a whole plan.
uint64_t mf_measure_steps(const struct measure_plan *plan);

/// Told after each sample, and every second or so between them; `done` of `total` steps. NULL for
/// none.
struct measure_listener {
    void (*report)(void *context, const struct simulation *simulation, uint64_t done,
                   uint64_t total);
    void *context;
    /// Steps until the next word at most, asked for after each; 0, or NULL: every second or so.
    /// With 1 it is called after every step, of some twice.
    int64_t (*steps)(void *context);
};

/// Take the samples of a plan whose equilibration is over: all of them, or after a restart those
/// that are still due by the number of the simulation's step.
/// @param[in] uses  what to measure, ended by one without an observable
/// Fails: as mf_simulation_run; NO_MEMORY. What was sampled before a failure stays.
enum status mf_measure_sample(struct simulation *simulation, const struct measure_plan *plan,
                              const struct observable_use *uses,
                              const struct measure_listener *listener) MUST_USE;

/// A temperature after equilibration [k_B T_0]; NaN if it is not known: without velocities and
/// without pairs in range.
struct measure_temperature {
    double mean;
    double error; ///< 0 with velocities: their mean is assessed as it is
};

/// Run an equilibration of plan->equilibration steps and take the temperature of its last tenth:
/// the mean kinetic one, or without velocities the configurational one, Σ|∇U|²/Σ∇²U over ten
/// snapshots, with the error that it would have if it were the set one (E. C. Fieller, J. R. Stat.
/// Soc. B 16, 175 (1954)).
/// Fails: as mf_simulation_run; NO_MEMORY. Tested: test_brownian, test_evaluate.
enum status mf_measure_settle(struct simulation *simulation, const struct measure_plan *plan,
                              struct measure_temperature *temperature,
                              const struct measure_listener *listener) MUST_USE;

/// The same for those who want no error.
enum status mf_measure_equilibrate(struct simulation *simulation, const struct measure_plan *plan,
                                   double *temperature,
                                   const struct measure_listener *listener) MUST_USE;
