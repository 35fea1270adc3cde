// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The candidates of an optimiser's round, measured by simulations in parallel.
#pragma once

#include "base/statistics.h"
#include "problem/decoder.h"
#include "problem/evaluate.h"
#include "matching/surrogate.h"
#include "optimise/optimiser.h"

#include <stddef.h>

enum { CANDIDATES_MOST = 1024 }; ///< in a round

struct candidates_parameters {
    struct evaluate_parameters evaluate;
    int warm_start, common_noise; ///< 0: no
};

/// What the run file says to a method that measures candidates. The method's own fields are offsets
/// into a struct of its own, which therefore comes first.
struct candidates_settings {
    union {
        max_align_t alignment;
        unsigned char bytes[512];
    } method;
    struct candidates_parameters candidates;
};

extern const struct field mf_candidates_fields[]; ///< of struct candidates_settings
extern const char *const mf_candidates_no_or_yes[];

/// For `struct inverse_method`.
struct inverse_sampling mf_candidates_sampling(const void *settings);

/// What was measured since mf_candidates_forget_survey.
struct candidates_survey {
    size_t evaluations;
    double least; ///< error; infinite if there is none
    struct running_mean alive;
    uint64_t failures;
};

struct candidates {
    const struct decoder *decoder;
    struct candidates_parameters parameters;
    double *errors, *variances; ///< shape [CANDIDATES_MOST]; an error is negative if not measured
    struct target_distance *distances; ///< shape [CANDIDATES_MOST, TARGETS]; not set of what failed
    double *features;                  ///< shape [CANDIDATES_MOST, features] of the targets
    struct surrogate surrogate;        ///< that remembers them
    double *target, *target_error;     ///< shape [features]
    double *first;                     ///< shape [genes]: the first candidate of the last round
    double *position;                  ///< shape [dimensions, particles]: where simulations begin
    double *best_position;             ///< where the best of this round ended
    uint32_t iteration, iterations;    ///< for progress: of the method, at most
    double best;                       ///< for progress: the method's error so far, or NaN
    struct candidates_survey survey;
    struct candidates_totals {
        uint64_t rounds, evaluations, steps;
        uint64_t remeasured; ///< candidates
        bool warm;           ///< whether there is a position to begin with
        double best_error;   ///< of this round
        uint64_t best_index;
    } totals;
};

/// Fails: NO_MEMORY.
enum status mf_candidates_init(struct candidates *candidates, const struct decoder *decoder,
                               const struct candidates_parameters *parameters) MUST_USE;
void mf_candidates_clear(struct candidates *candidates);

/// Measure all candidates that have no error yet. A failed simulation is the worst error.
/// Seeds depend on the round and the candidate's number alone: the same bits for any threads.
/// Fails: INTERRUPTED, with what was measured kept for a checkpoint; NO_MEMORY; BAD_INPUT.
enum status mf_candidates_measure(struct candidates *candidates,
                                  const struct optimiser_round *round, double hopeless,
                                  const struct inverse_listener *listener) MUST_USE;

/// Forget the errors, and begin the next round's simulations where the best of this one ended.
void mf_candidates_next_round(struct candidates *candidates);

/// Mean error of `count` fresh measurements of one candidate, the noise in each, and the variance
/// of the mean; OPTIMISER_FAILED if one of them fails.
/// @param[out] distance  shape [TARGETS]: means, or NULL
enum status mf_candidates_remeasure(struct candidates *candidates, const double *genes,
                                    size_t count, double *error, double *noise, double *variance,
                                    struct target_distance *distance) MUST_USE;

void mf_candidates_forget_survey(struct candidates *candidates);

/// Say into `reason` that simulations succeeded, but `why` there is no result; nothing if none did.
void mf_candidates_tell_failure(const struct candidates *candidates, const char *why,
                                char reason[INVERSE_REASON_SIZE]);

enum { CANDIDATES_SPANS = 9 + SURROGATE_SPANS };
size_t mf_candidates_spans(struct candidates *candidates, struct memory_span *spans);
