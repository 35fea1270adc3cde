// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Independent Markov chains that count pairs: what the inversions of g(r) measure.
#pragma once

#include "base/comoments.h"
#include "base/memory.h"
#include "dynamics/metropolis.h"
#include "inverse/inverse.h"

enum { REPLICAS_MOST = 64 };

/// Consecutive parts of each chain's samples; their scatter gives the statistical error.
enum { REPLICAS_BLOCKS = 4 };

struct replicas {
    const struct rdf_bins *bins; ///< borrowed
    const struct box *box;       ///< borrowed
    size_t count;
    struct replica {
        struct metropolis sampler;
        struct comoments counts; ///< of the samples
        double *sample;          ///< shape [bins + 1]: S, then the virial Σ r·F [k_B T_0]
        double *block;           ///< shape [REPLICAS_BLOCKS, bins]: mean S of each block
    } member[REPLICAS_MOST];
    struct comoments counts; ///< of all: S of the bins, then the virial
};

struct replicas_plan {
    int64_t equilibration; ///< sweeps before the samples
    int64_t samples;       ///< of each chain
    int64_t every;         ///< sweeps between them
};

/// `count` chains of `particles` particles each on a lattice. Must be cleared, also after a
/// failure.
/// @param[in] potential  borrowed; may be exchanged between runs
/// Fails: as metropolis_init.
enum status replicas_init(struct replicas *replicas, size_t count, const struct rdf_bins *bins,
                          const struct box *box, size_t particles, const struct table *potential,
                          double temperature, uint64_t seed) MUST_USE;
void replicas_clear(struct replicas *replicas);

/// Equilibrate, then sample; the chains in parallel, merged in order: the same bits for any number
/// of threads. `progress` is told after each chain, with `done` and `total` filled in.
/// Fails: NO_MEMORY, INTERRUPTED. Tested: test_inversion, test_fit.
enum status replicas_run(struct replicas *replicas, const struct replicas_plan *plan, int threads,
                         const struct inverse_progress *progress,
                         const struct inverse_listener *listener) MUST_USE;

/// How many samples count as one independent, from the scatter of the block means, averaged over
/// the bins from `first` on because that of one bin is noisy.
/// @param[in] ideal  shape [bins]: S if g were 1
double replicas_inefficiency(const struct replicas *replicas, const double *ideal, size_t first);

/// What a checkpoint keeps; returns the number of spans.
size_t replicas_spans(struct replicas *replicas, struct memory_span *span);
