// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Independent samplers that count pairs: what the inversions of g(r) measure.
#pragma once

#include "base/comoments.h"
#include "base/memory.h"
#include "problem/inverse.h"
#include "inversion/sampler.h"

enum { REPLICAS_MAX = 64 };

/// Consecutive parts of each sampler's samples; their scatter gives the statistical error.
enum { REPLICAS_BLOCKS = 4 }; // even, so that they can be joined in pairs

/// Ways in which one half of the replicas begins on one side of equilibrium, and the other half on
/// the other side.
enum replicas_side {
    REPLICAS_STRETCH, ///< molecules are coiled, or stretched
    REPLICAS_TILT,    ///< mixtures begin mixed, or with a wave of composition
    REPLICAS_SIDES
};

/// Replicas of which both sides are told apart by their scatter: fewer begin so, too, but are too
/// few to tell.
enum { REPLICAS_MIN_OF_SIDES = 8 };

struct replicas {
    size_t bins, numbers, count; ///< numbers of a sample: bins, then sums and integrals
    bool begins[REPLICAS_SIDES]; ///< on both sides of it
    int64_t every;               ///< sweeps between the present samples
    struct replica {
        struct sampler sampler;
        struct comoments counts; ///< of the samples
        double *sample;          ///< of mf_sampler_sample
        double *block;           ///< shape [REPLICAS_BLOCKS, numbers]: means of each block
        double acceptance;       ///< part of the moves that were taken, since the last begin
    } member[REPLICAS_MAX];
    struct comoments counts; ///< of all, as a sample has them
};

/// On which side replica k begins, 1 or −1.
static inline double replicas_side(size_t k, enum replicas_side side) {
    return k >> side & 1 ? 1 : -1;
}

struct replicas_plan {
    bool scatter;          ///< first: the particles are placed again, without order
    int64_t equilibration; ///< sweeps before the samples
    int64_t block_samples; ///< of each of the REPLICAS_BLOCKS of each sampler
    int64_t every;         ///< sweeps between them
};

/// `count` samplers of one system, each with a seed of its own. Must be cleared, also after a
/// failure. Fails: as mf_sampler_init.
enum status mf_replicas_init(struct replicas *replicas, size_t count, enum sampler_kind kind,
                             const struct sampler_system *system) MUST_USE;
void mf_replicas_clear(struct replicas *replicas);

/// Equilibrate, then sample; the samplers in parallel, merged in order: the same bits for any
/// number of threads. `progress` is reported after each, with `done` and `total` filled in. Fails:
/// NO_MEMORY, INTERRUPTED. Tested: test_inversion, test_fit.
enum status mf_replicas_run(struct replicas *replicas, const struct replicas_plan *plan,
                            int threads, const struct inverse_progress *progress,
                            const struct inverse_listener *listener) MUST_USE;

/// Go on with the same potential until there are twice as many samples, and double the plan. As
/// mf_replicas_run, without equilibration.
enum status mf_replicas_double(struct replicas *replicas, struct replicas_plan *plan, int threads,
                               const struct inverse_progress *progress,
                               const struct inverse_listener *listener) MUST_USE;

/// Sweeps of a plan, of each replica.
static inline uint64_t replicas_plan_sweeps(const struct replicas_plan *plan) {
    return (uint64_t)(REPLICAS_BLOCKS * plan->block_samples * plan->every);
}

struct replicas_mean {
    double mean, error;
};

/// One of the sums of a sample, enum sampler_sum, or of the integrals after them, with the
/// standard error that is the larger of two: by the scatter of the replicas, and by that of all
/// samples.
/// @param[in] inefficiency  of mf_replicas_inefficiency
struct replicas_mean mf_replicas_mean(const struct replicas *replicas, size_t sum,
                                      double inefficiency);

/// Part of the moves that were taken, the mean over the samplers.
double mf_replicas_acceptance(const struct replicas *replicas);

/// How many samples count as one independent, from the scatter of the means of parts of each
/// replica's samples, averaged over `count` bins, the numbers of which are in `seen`, because that
/// of one bin is noisy. Each bin counts as much: by their variances few of them would decide.
/// @param[in] parts  REPLICAS_BLOCKS, or 1 where samples remember more than a block
double mf_replicas_inefficiency(const struct replicas *replicas, size_t parts, const size_t *seen,
                                size_t count);

/// Variance of the replicas' means over what the scatter of the blocks within them makes of it:
/// near 1 if all sample the same, and large if they are frozen in structures of their own. A.
/// Gelman and D. B. Rubin, Stat. Sci. 7, 457 (1992). Parameters as mf_replicas_inefficiency.
/// @param[in] ideal  shape [bins]: S if g were 1
/// Tested: test_replicas.
double mf_replicas_disagreement(const struct replicas *replicas, const double *ideal,
                                const size_t *seen, size_t count);

/// What a checkpoint keeps; returns the number of spans.
size_t mf_replicas_spans(struct replicas *replicas, struct memory_span *span);
