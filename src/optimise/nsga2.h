// SPDX-License-Identifier: GPL-3.0-or-later
/// @file NSGA-II: several objectives at once, without weights, by sorting into fronts.
///
/// K. Deb, A. Pratap, S. Agarwal and T. Meyarivan, IEEE Trans. Evol. Comput. 6, 182 (2002). Ask and
/// tell as in optimise/optimiser.h, but for a row of objectives where that has one error. Parents
/// and children compete for the places of the next parents: first by rank, the number of the front
/// they are on, then by crowding distance, the room that their neighbours on the front leave them.
///
/// Objectives may be noisy. A parent's are the means of its measurements, and every round measures
/// some members of the first front again, those measured least first: a lucky draw does not stay.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "optimise/optimiser.h"

struct nsga2_parameters {
    int64_t population, generations;
    double spread;            ///< of the first population about the start
    double mutation_exponent; ///< eta of polynomial mutation
};

extern const struct field mf_nsga2_fields[];

/// Genes are in [0, 1].
struct nsga2_space {
    size_t genes, objectives; ///< at least 1
    const double *start;      ///< shape [genes], or NULL: the first population is anywhere
    uint64_t seed;
};

enum { NSGA2_INJECTED = 16 }; ///< children of a round, at most

struct nsga2 {
    struct nsga2_parameters parameters;
    size_t genes, objectives, population;
    uint64_t seed;
    double *x;        ///< shape [3 population, genes]: parents, children, parents to measure again
    double *value;    ///< shape [2 population, objectives]: means; OPTIMISER_FAILED: failed
    double *measured; ///< shape [2 population]: measurements in these means
    uint32_t *rank;   ///< shape [2 population]: front, from 1; of the parents alone after a tell
    double *crowding; ///< shape [2 population]: room on it; infinite at its ends
    uint32_t *again;  ///< shape [population]: parents that the round measures again
    double *injected; ///< shape [NSGA2_INJECTED, genes]
    struct nsga2_progress {
        uint32_t generation; ///< that have been told
        uint32_t is_made;    ///< whether the next round is
        uint32_t again, injected;
    } progress;
};

/// Fails: NO_MEMORY; BAD_INPUT without genes or objectives. mf_nsga2_clear must follow all the
/// same.
enum status mf_nsga2_init(struct nsga2 *nsga2, const struct nsga2_parameters *parameters,
                          const struct nsga2_space *space) MUST_USE;
void mf_nsga2_clear(struct nsga2 *nsga2);

/// The candidates of the next round; asking again gives the same.
struct optimiser_round mf_nsga2_ask(struct nsga2 *nsga2);

/// What they measured. A candidate is failed if one of its objectives is OPTIMISER_FAILED, beyond
/// that or not finite: all others dominate it.
/// @param[in] value  shape [count, objectives]
/// Fails: NO_MEMORY. Tested: test_nsga2.
enum status mf_nsga2_tell(struct nsga2 *nsga2, const double *value) MUST_USE;

/// Add a measurement to the means of a parent, and sort the parents again. Fails: NO_MEMORY.
enum status mf_nsga2_add_measurement(struct nsga2 *nsga2, size_t parent,
                                     const double *value) MUST_USE;

/// Let the next round have a child of these genes; once the round has been asked for, the one
/// after. More than NSGA2_INJECTED, or than half the population, are forgotten.
void mf_nsga2_inject(struct nsga2 *nsga2, const double *genes);

/// Parents: none before the first tell. And the genes of one, shape [genes].
size_t mf_nsga2_parents(const struct nsga2 *nsga2);
const double *mf_nsga2_parent(const struct nsga2 *nsga2, size_t parent);

bool mf_nsga2_is_over(const struct nsga2 *nsga2);

/// Mean over genes of the standard deviation over the parents.
double mf_nsga2_diversity(const struct nsga2 *nsga2);

/// The state between rounds, for a checkpoint.
enum { NSGA2_SPANS = 8 };
size_t mf_nsga2_spans(struct nsga2 *nsga2, struct memory_span *spans);

/// @name Parts (nsga2_sort.c, nsga2_operators.c)
struct rng_sequence;

/// Whether a is nowhere worse than b, and somewhere better.
bool mf_nsga2_dominates(const double *a, const double *b, size_t objectives);

/// Fronts: rank 1 for those that nobody dominates, 2 for those that only rank 1 dominates, …
/// @param[in]  value  shape [count, objectives]
/// @param[out] rank   shape [count]
/// Fails: NO_MEMORY.
enum status mf_nsga2_sort(const double *value, size_t count, size_t objectives,
                          uint32_t *rank) MUST_USE;

/// Crowding distances: the sum over objectives of the difference between both neighbours on the
/// front, as a part of the front's range. Fails: NO_MEMORY.
enum status mf_nsga2_crowd(const double *value, size_t count, size_t objectives,
                           const uint32_t *rank, double *crowding) MUST_USE;

/// Simulated binary crossover of two individuals in place, within [0, 1]: K. Deb and R. B. Agrawal,
/// Complex Systems 9, 115 (1995). Children are as near to their parents as the exponent is large.
void mf_nsga2_cross(double *a, double *b, size_t genes, double exponent,
                    struct rng_sequence *random);

/// A gene moved by polynomial mutation within [0, 1].
double mf_nsga2_mutate(double gene, double exponent, struct rng_sequence *random);
