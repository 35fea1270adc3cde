// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Candidates of an optimiser that asks for them one at a time: a thread that has measured
/// one takes the next at once, also from round to round.
#pragma once

#include "base/parallel_stream.h"
#include "matching/individuals.h"
#include "matching/population.h"
#include "optimise/optimiser.h"

struct asynchronous {
    struct population *population;
    struct individuals *individuals;
    const struct optimiser *optimiser;
    void *optimiser_state;
    struct parallel_stream *threads;       ///< NULL before the first round
    struct optimiser_candidate *candidate; ///< the next one
    double *variables;                     ///< shape [POPULATION_MOST, variables]: of this round
    struct asynchronous_standing {
        uint64_t asked; ///< candidates, each with a seed of its own
        uint64_t here;  ///< of this round, measured
    } standing;
};

/// Fails with BAD_INPUT if a setting of the population belongs to rounds.
enum status mf_asynchronous_check(const struct population_parameters *parameters) MUST_USE;

/// What it is given is borrowed. Fails: NO_MEMORY.
enum status mf_asynchronous_init(struct asynchronous *asynchronous, struct population *population,
                                 struct individuals *individuals, const struct optimiser *optimiser,
                                 void *optimiser_state) MUST_USE;

/// Waits for the simulations that are going on, and forgets them.
void mf_asynchronous_clear(struct asynchronous *asynchronous);

/// Measure candidates until the optimiser has a whole round, while others go on; `finished` once
/// it wants no more and all are measured. What was measured is kept if it fails. Among ranks
/// (base/ranks.h) threads of all measure, while the states of rank 0 alone, its population's,
/// individuals' and optimiser's too, follow: they are to be shared next, also if it fails.
/// Fails: INTERRUPTED, NO_MEMORY, BAD_INPUT.
enum status mf_asynchronous_take_round(struct asynchronous *asynchronous,
                                       const struct inverse_listener *listener,
                                       bool *finished) MUST_USE;

/// Candidates that were being measured are not among them: who goes on asks for others.
enum { ASYNCHRONOUS_SPANS = 2 };
size_t mf_asynchronous_spans(struct asynchronous *asynchronous, struct memory_span *spans);
