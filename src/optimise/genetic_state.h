// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the genetic algorithm keeps as an optimiser, by generations (genetic_optimiser.c) and
/// asynchronously (genetic_asynchronous.c).
#pragma once

#include "optimise/genetic.h"
#include "optimise/optimiser.h"

struct genetic_state {
    struct genetic genetic;
    /// Shape [population + remeasurements]: scratch by generations, asynchronously of the rows.
    double *errors;
    double *challenger; ///< shape [genes]: scratch by generations
    // asynchronously
    uint64_t *number; ///< shape [population]: which individual a row is, as `parent`
    struct genetic_standing {
        uint64_t asked;                 ///< individuals of the first population, and children
        uint64_t joined;                ///< individuals that were ever rows of the population
        uint64_t challenge;             ///< number of the last challenger, from 1; 0: none yet
        uint64_t challenger_number;     ///< which individual it is
        uint64_t elite, elite_number;   ///< the same of the challenger who became the elite
        double fresh_sum;               ///< of fresh errors of the challenger that were told,
        int64_t fresh;                  ///< so many
        int64_t challenging, elite_due; ///< whether it waits; whether the elite is to be measured
    } stream;
    int64_t copies; ///< of the challenger that were asked for since there is this state
};

/// Whether all generations are measured, and perhaps a last challenger is left.
bool mf_genetic_is_over(const struct genetic *genetic);

/// Index of the best individual below the elite's error, −1 if there is none. Twins of the elite
/// are left out: they would win by a lucky draw of the same genes.
int64_t mf_genetic_find_challenger(const struct genetic *genetic, const double *errors);

extern const struct optimiser_stream mf_genetic_stream;

/// Begin without anybody measured. Fails: BAD_INPUT with islands.
enum status mf_genetic_begin_stream(struct genetic_state *state) MUST_USE;

/// What a checkpoint has besides. Returns how many.
size_t mf_genetic_stream_spans(struct genetic_state *state, struct memory_span *spans);
