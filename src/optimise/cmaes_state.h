// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What CMA-ES keeps, by rounds (cmaes.c) and asynchronously (cmaes_asynchronous.c).
#pragma once

#include "optimise/cmaes.h"
#include "optimise/optimiser.h"

struct cmaes_state {
    struct cmaes_parameters parameters;
    struct optimiser_space space;
    struct cmaes_distribution distribution;
    struct cmaes_strategy strategy;
    size_t most;       ///< candidates of a round, at most; there is room for them
    double *steps;     ///< of the candidates, shape [most, variables]
    double *variables; ///< the candidates, shape [most, variables]
    double *errors;    ///< shape [most]: of the candidates
    double *variances; ///< shape [most]: of the errors, where they are told one by one
    double *record;    ///< variables of `record_error`, shape [variables]
    double *history;   ///< least errors of the last rounds, a ring, shape [most_history]
    uint64_t sampled;  ///< the round whose candidates these are, counted from 1; 0: none yet
    struct cmaes_progress {
        uint64_t rounds;        ///< told
        uint64_t descents;      ///< ended
        uint64_t history_count; ///< of this descent
        double population;      ///< of this descent, not yet rounded
        double noise;           ///< smoothed share of noise among errors
        double record_error;    ///< of the best candidate, or, with noise, of the best descent
        double median;          ///< of the last round
        double discard_above;
        int64_t noisy, over, settled, known;
        uint64_t asked; ///< candidates, one by one
        uint64_t here;  ///< of this round, one by one, whose errors are told
    } progress;
};

/// Fill the numbers of the strategy, which no checkpoint keeps since they follow from the
/// population.
void mf_cmaes_follow_population(struct cmaes_state *state);

/// A candidate that is `step` away from the mean, in the caller's variables.
void mf_cmaes_place(const struct cmaes_state *state, const double *step, double *variables);

/// End a round whose steps, variables and errors are in the state.
/// @param[in] variances  shape [population], of the errors
/// Fails: NO_MEMORY.
enum status mf_cmaes_end_round(struct cmaes_state *state, const double *variances) MUST_USE;

extern const struct optimiser_stream mf_cmaes_stream;
