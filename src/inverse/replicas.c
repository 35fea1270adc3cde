// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/replicas.h"

#include "base/rng.h"
#include "base/statistics.h"

#include <math.h>
#include <string.h>

enum status replicas_init(struct replicas *replicas, size_t count, enum sampler_kind kind,
                          const struct sampler_system *system) {
    enum status status = STATUS_OK;
    const size_t bins = system->bins;
    struct sampler_system own = *system;
    *replicas = (struct replicas){.bins = bins, .count = count};
    CHECK(comoments_init(&replicas->counts, bins + 1));
    for (size_t k = 0; k < count; k++) {
        struct replica *replica = &replicas->member[k];
        NEW_ARRAY(replica->sample, bins + 1);
        NEW_ARRAY(replica->block, REPLICAS_BLOCKS * bins);
        CHECK(comoments_init(&replica->counts, bins + 1));
        own.seed = rng_child_seed(system->seed, RNG_EVALUATION, (uint32_t)k, 0);
        CHECK(sampler_init(&replica->sampler, kind, &own));
    }
done:
    return status;
}

void replicas_clear(struct replicas *replicas) {
    for (size_t k = 0; k < replicas->count; k++) {
        struct replica *replica = &replicas->member[k];
        sampler_clear(&replica->sampler);
        comoments_clear(&replica->counts);
        memory_free(replica->sample);
        memory_free(replica->block);
    }
    comoments_clear(&replicas->counts);
    *replicas = (struct replicas){0};
}

/// Equilibrate one chain, then take its samples block by block.
static enum status run_one(const struct replicas *replicas, struct replica *replica,
                           const struct replicas_plan *plan) {
    const size_t bins = replicas->bins;
    comoments_reset(&replica->counts);
    memset(replica->block, 0, REPLICAS_BLOCKS * bins * sizeof *replica->block);
    TRY(sampler_begin(&replica->sampler));
    TRY(sampler_equilibrate(&replica->sampler, (uint64_t)plan->equilibration));
    for (int64_t block = 0; block < REPLICAS_BLOCKS; block++) {
        const int64_t begin = plan->samples * block / REPLICAS_BLOCKS;
        const int64_t end = plan->samples * (block + 1) / REPLICAS_BLOCKS;
        for (int64_t sample = begin; sample < end; sample++) {
            TRY(sampler_sample(&replica->sampler, (uint64_t)plan->every, replica->sample));
            comoments_add(&replica->counts, replica->sample);
            for (size_t a = 0; a < bins; a++)
                replica->block[(size_t)block * bins + a] +=
                    replica->sample[a] / (double)(end - begin);
        }
    }
    return STATUS_OK;
}

/// The one that decides: an interrupted run must not be taken for an unstable one, whichever thread
/// comes first.
static enum status worse(enum status a, enum status b) {
    return a == STATUS_OK || a == STATUS_UNSTABLE ? b == STATUS_OK ? a : b : a;
}

enum status replicas_run(struct replicas *replicas, const struct replicas_plan *plan, int threads,
                         const struct inverse_progress *progress,
                         const struct inverse_listener *listener) {
    enum status worst = STATUS_OK;
    uint64_t done = 0;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t k = 0; k < replicas->count; k++) {
        const enum status status = run_one(replicas, &replicas->member[k], plan);
#pragma omp critical
        {
            worst = worse(worst, status);
            struct inverse_progress now = *progress;
            now.done = ++done;
            now.total = replicas->count;
            listener->tell(listener->context, &now);
        }
    }
    if (worst != STATUS_OK)
        return status_fail(worst, "%s",
                           worst == STATUS_INTERRUPTED ? "interrupted"
                           : worst == STATUS_UNSTABLE  ? "the simulations are unstable"
                                                       : "no memory for the replicas");
    comoments_reset(&replicas->counts);
    for (size_t k = 0; k < replicas->count; k++)
        comoments_merge(&replicas->counts, &replicas->member[k].counts);
    return STATUS_OK;
}

double replicas_inefficiency(const struct replicas *replicas, const double *ideal, size_t first) {
    const size_t bins = replicas->bins;
    double scatter = 0, variance = 0;
    for (size_t a = first; a < bins; a++) {
        struct running_mean blocks = {0};
        for (size_t k = 0; k < replicas->count; k++)
            for (size_t b = 0; b < REPLICAS_BLOCKS; b++)
                statistics_add(&blocks, replicas->member[k].block[b * bins + a]);
        // Weighted by 1/S²: bins with many pairs would drown the others.
        const double weight = 1 / (ideal[a] * ideal[a]);
        scatter += weight * blocks.squares / (blocks.count - 1);
        variance += weight * comoments_covariance(&replicas->counts, a, a);
    }
    const double block_samples =
        replicas->counts.count / (double)(replicas->count * REPLICAS_BLOCKS);
    return variance > 0 ? fmax(1, scatter / variance * block_samples) : 1;
}

size_t replicas_spans(struct replicas *replicas, struct memory_span *span) {
    size_t n = 0;
    for (size_t k = 0; k < replicas->count; k++)
        n += sampler_spans(&replicas->member[k].sampler, span + n);
    return n;
}
