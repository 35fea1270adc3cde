// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Functions with known minima, and a drive of an optimiser over them.
#pragma once

#include "optimise/optimiser.h"

/// A function to be minimised in a box; its least value is 0, where all variables are `optimum`.
struct landscape {
    const char *name;
    double (*error)(const double *variables, size_t count);
    double minimum, maximum, optimum;
};

extern const struct landscape landscape_sphere; ///< Σ (x − 0.3)² in [0, 1]
extern const struct landscape landscape_rosenbrock; ///< Σ 100 (x' − x²)² + (1 − x)² in [−2, 2]
extern const struct landscape landscape_rastrigin; ///< Σ 10 + y² − 10 cos(2π y), y = x − 1, ±5
extern const struct landscape landscape_edge;      ///< Σ x in [0, 1]: the optimum is a corner

/// How to drive.
struct landscape_drive {
    const struct landscape *landscape;
    size_t variables;
    uint64_t seed;
    const double *start;  ///< or NULL
    double noise;         ///< standard deviation of normal noise on each error
    double failing;       ///< share of candidates that fail, by turns with 1e9, NaN and ±infinity
    double target;        ///< stop once a candidate is below it
    uint64_t evaluations; ///< stop after so many; 0: never
    size_t max;           ///< candidates that a round may have; 0: any number
};

/// What came of it.
struct landscape_result {
    uint64_t rounds, evaluations;
    double min; ///< error of the best candidate, without noise
    double
        best_candidate; ///< error of the best candidate, without noise; HUGE_VAL if there was none
    bool finished;      ///< by itself
};

/// An optimiser with its parameters and state.
struct landscape_run {
    const struct optimiser *optimiser;
    void *parameters, *state;
};

/// The default parameters of an optimiser; mf_memory_free them.
void *landscape_parameters(const struct optimiser *optimiser);

/// Set a number, integer or choice by its field's name; the test fails if there is none.
void landscape_set(const struct optimiser *optimiser, void *parameters, const char *name,
                   double value);

/// A parameter by its field's name.
struct landscape_setting {
    const char *name;
    double value;
};

/// The default parameters with some settings, up to `max` of them or the first without a name.
void *landscape_parameters_with(const struct optimiser *optimiser,
                                const struct landscape_setting *settings, int max);

/// A new state. `parameters` are borrowed; landscape_end frees the state.
struct landscape_run landscape_begin(const struct optimiser *optimiser, void *parameters,
                                     const struct landscape_drive *drive);
void landscape_end(struct landscape_run *run);

/// One round: ask twice and compare, check the bounds, measure, tell. Adds to the result; false if
/// the optimiser has finished.
bool landscape_step(struct landscape_run *run, const struct landscape_drive *drive,
                    struct landscape_result *result);

/// All of it, from a new state to the target, the end, or as many evaluations.
struct landscape_result landscape_minimise(const struct optimiser *optimiser, void *parameters,
                                           const struct landscape_drive *drive);
