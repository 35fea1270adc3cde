// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/replicas.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/spent.h"
#include "base/statistics.h"

#include <math.h>
#include <string.h>

/// Whether there is more than one component.
static bool is_mixture(const struct sampler_system *system) {
    if (system->molecules == NULL)
        return composition_is_mixed(system->composition);
    const struct topology *topology = &system->molecules->topology;
    return topology->kinds > 1 ||
           (size_t)topology->kind[0].count * (size_t)topology->kind[0].beads < topology->particles;
}

/// Whether there are molecules that can be coiled or stretched.
static bool has_chains(const struct sampler_system *system) {
    bool has = false;
    for (int k = 0; system->molecules && k < system->molecules->topology.kinds; k++)
        has = has || system->molecules->topology.kind[k].beads > 2;
    return has;
}

/// Beginnings on both sides of equilibrium: half of the replicas with molecules that are stretched,
/// half with coiled ones, and of mixtures each half with a wave of composition and without.
static struct placement_bias begin_apart(const struct replicas *replicas, size_t k) {
    static const double stretch = 0.35, tilt = 0.6;
    const bool tilts = replicas->begins[REPLICAS_TILT] && replicas_side(k, REPLICAS_TILT) > 0;
    return (struct placement_bias){.stretch = stretch * replicas_side(k, REPLICAS_STRETCH),
                                   .tilt = tilts ? tilt : 0};
}

enum status mf_replicas_init(struct replicas *replicas, size_t count, enum sampler_kind kind,
                             const struct sampler_system *system) {
    enum status status = STATUS_OK;
    const size_t bins = mf_sampler_bins(system), numbers = mf_sampler_numbers(system);
    struct sampler_system own = *system;
    *replicas =
        (struct replicas){.bins = bins,
                          .numbers = numbers,
                          .count = count,
                          .begins = {[REPLICAS_STRETCH] = !system->engine && has_chains(system),
                                     [REPLICAS_TILT] = !system->engine && is_mixture(system)}};
    CHECK(mf_comoments_init(&replicas->counts, numbers));
    for (size_t k = 0; k < count; k++) {
        struct replica *replica = &replicas->member[k];
        NEW_ARRAY(replica->sample, numbers);
        NEW_ARRAY(replica->block, REPLICAS_BLOCKS * numbers);
        CHECK(mf_comoments_init(&replica->counts, numbers));
        own.seed = mf_rng_child_seed(system->seed, RNG_EVALUATION, (uint32_t)k, 0);
        own.replica = k;
        own.bias = begin_apart(replicas, k);
        CHECK(mf_sampler_init(&replica->sampler, kind, &own));
    }
done:
    return status;
}

void mf_replicas_clear(struct replicas *replicas) {
    for (size_t k = 0; k < replicas->count; k++) {
        struct replica *replica = &replicas->member[k];
        mf_sampler_clear(&replica->sampler);
        mf_comoments_clear(&replica->counts);
        mf_memory_free(replica->sample);
        mf_memory_free(replica->block);
    }
    mf_comoments_clear(&replicas->counts);
    *replicas = (struct replicas){0};
}

/// Take the samples of block first … last − 1.
static enum status fill_blocks(struct replica *replica, size_t numbers, size_t first, size_t last,
                               const struct replicas_plan *plan) {
    const double each = (double)plan->block_samples, begun = clock_thread_seconds();
    for (size_t block = first; block < last; block++) {
        double *mean = replica->block + block * numbers;
        memset(mean, 0, numbers * sizeof *mean);
        for (int64_t sample = 0; sample < plan->block_samples; sample++) {
            TRY(mf_sampler_sample(&replica->sampler, (uint64_t)plan->every, replica->sample));
            mf_comoments_add(&replica->counts, replica->sample);
            for (size_t a = 0; a < numbers; a++)
                mean[a] += replica->sample[a] / each;
        }
    }
    mf_spent_add(SPENT_SAMPLES, clock_thread_seconds() - begun);
    return STATUS_OK;
}

/// Equilibrate one sampler, then take its samples.
static enum status run_one(struct replica *replica, size_t numbers,
                           const struct replicas_plan *plan) {
    const double begun = clock_thread_seconds();
    mf_comoments_reset(&replica->counts);
    if (plan->scatter)
        TRY(mf_sampler_scatter(&replica->sampler));
    TRY(mf_sampler_begin(&replica->sampler));
    TRY(mf_sampler_equilibrate(&replica->sampler, (uint64_t)plan->equilibration));
    mf_spent_add(SPENT_EQUILIBRATION, clock_thread_seconds() - begun);
    return fill_blocks(replica, numbers, 0, REPLICAS_BLOCKS, plan);
}

/// Two blocks become one, half as many; then as many samples again. The sampler begins as after a
/// restart, since another rank may have taken the samples before.
static enum status double_one(struct replica *replica, size_t numbers,
                              const struct replicas_plan *plan) {
    enum { HALF = REPLICAS_BLOCKS / 2 };
    double *block = replica->block;
    TRY(mf_sampler_begin(&replica->sampler));
    TRY(mf_sampler_equilibrate(&replica->sampler, 0));
    for (size_t b = 0; b < HALF; b++)
        for (size_t a = 0; a < numbers; a++)
            block[b * numbers + a] =
                0.5 * (block[2 * b * numbers + a] + block[(2 * b + 1) * numbers + a]);
    return fill_blocks(replica, numbers, HALF, REPLICAS_BLOCKS, plan);
}

/// Replicas at work.
struct work {
    struct replicas *replicas;
    const struct replicas_plan *plan;
    enum status (*one)(struct replica *, size_t, const struct replicas_plan *);
    struct inverse_progress progress;
    const struct inverse_listener *listener;
};

static enum status run_member(void *context, size_t k, void *result) {
    const struct work *work = context;
    (void)result;
    struct replica *replica = &work->replicas->member[k];
    TRY(work->one(replica, work->replicas->numbers, work->plan));
    replica->acceptance = mf_sampler_acceptance(&replica->sampler);
    return STATUS_OK;
}

/// What the samples of a replica leave.
static size_t list_sampled(void *context, size_t k, struct memory_span *span) {
    const struct work *work = context;
    struct replica *replica = &work->replicas->member[k];
    const size_t block = REPLICAS_BLOCKS * work->replicas->numbers * sizeof *replica->block;
    size_t n = 0;
    span[n++] = (struct memory_span){replica->block, block};
    span[n++] = (struct memory_span){&replica->acceptance, sizeof replica->acceptance};
    n += mf_comoments_spans(&replica->counts, span + n);
    return n + mf_sampler_spans(&replica->sampler, span + n);
}

static void report_one(void *context, size_t k, const void *result) {
    struct work *work = context;
    (void)k, (void)result;
    work->progress.done++;
    work->listener->report(work->listener->context, &work->progress);
}

/// Run all, each by `one`.
static enum status
run_all(struct replicas *replicas, const struct replicas_plan *plan, int threads,
        const struct inverse_progress *progress, const struct inverse_listener *listener,
        enum status (*one)(struct replica *, size_t, const struct replicas_plan *)) {
    struct work work = {replicas, plan, one, *progress, listener};
    work.progress.done = 0;
    work.progress.total = replicas->count;
    TRY(mf_parallel_try(&(struct parallel_tasks){.count = replicas->count,
                                                 .threads = threads,
                                                 .run = run_member,
                                                 .take = report_one,
                                                 .context = &work,
                                                 .spans = list_sampled}));
    mf_comoments_reset(&replicas->counts);
    for (size_t k = 0; k < replicas->count; k++)
        mf_comoments_merge(&replicas->counts, &replicas->member[k].counts);
    return STATUS_OK;
}

/// Tell all samplers what comes, before the first of them is waited for.
static enum status announce(struct replicas *replicas, const struct replicas_plan *plan,
                            bool scatter, int64_t lead, int64_t blocks) {
    for (size_t k = 0; k < replicas->count; k++)
        TRY(mf_sampler_announce(&replicas->member[k].sampler, scatter, (uint64_t)lead,
                                (uint64_t)(blocks * plan->block_samples), (uint64_t)plan->every));
    return STATUS_OK;
}

enum status mf_replicas_run(struct replicas *replicas, const struct replicas_plan *plan,
                            int threads, const struct inverse_progress *progress,
                            const struct inverse_listener *listener) {
    replicas->every = plan->every;
    TRY(announce(replicas, plan, plan->scatter, plan->equilibration, REPLICAS_BLOCKS));
    return run_all(replicas, plan, threads, progress, listener, run_one);
}

enum status mf_replicas_double(struct replicas *replicas, struct replicas_plan *plan, int threads,
                               const struct inverse_progress *progress,
                               const struct inverse_listener *listener) {
    plan->block_samples *= 2;
    TRY(announce(replicas, plan, false, 0, REPLICAS_BLOCKS / 2));
    return run_all(replicas, plan, threads, progress, listener, double_one);
}

/// Mean of number a over part p of `parts` of a replica's samples.
static double mean_of_part(const struct replicas *replicas, size_t k, size_t p, size_t parts,
                           size_t a) {
    const size_t length = REPLICAS_BLOCKS / parts;
    double sum = 0;
    for (size_t b = p * length; b < (p + 1) * length; b++)
        sum += replicas->member[k].block[b * replicas->numbers + a];
    return sum / (double)length;
}

double mf_replicas_inefficiency(const struct replicas *replicas, size_t parts, const size_t *seen,
                                size_t count) {
    double sum = 0, bins = 0;
    for (size_t n = 0; n < count; n++) {
        const size_t a = seen[n];
        const double variance = mf_comoments_covariance(&replicas->counts, a, a);
        struct running_mean means = {0};
        if (!(variance > 0))
            continue;
        for (size_t k = 0; k < replicas->count; k++)
            for (size_t p = 0; p < parts; p++)
                mf_statistics_add(&means, mean_of_part(replicas, k, p, parts, a));
        sum += means.squares / (means.count - 1) / variance;
        bins++;
    }
    const double samples = replicas->counts.count / (double)(replicas->count * parts);
    return bins > 0 ? fmax(1, sum / bins * samples) : 1;
}

double mf_replicas_disagreement(const struct replicas *replicas, const double *ideal,
                                const size_t *seen, size_t count) {
    double between = 0, within = 0;
    for (size_t n = 0; n < count; n++) {
        const size_t a = seen[n];
        const double weight = 1 / (ideal[a] * ideal[a]);
        struct running_mean means = {0};
        for (size_t k = 0; k < replicas->count; k++) {
            struct running_mean blocks = {0};
            for (size_t b = 0; b < REPLICAS_BLOCKS; b++)
                mf_statistics_add(&blocks, replicas->member[k].block[b * replicas->numbers + a]);
            mf_statistics_add(&means, blocks.mean);
            within += weight * blocks.squares / (blocks.count - 1) / (double)replicas->count;
        }
        between += weight * means.squares / (means.count - 1);
    }
    if (!(within > 0))
        return between > 0 ? INFINITY : 1;
    return REPLICAS_BLOCKS * between / within;
}

struct replicas_mean mf_replicas_mean(const struct replicas *replicas, size_t sum,
                                      double inefficiency) {
    const size_t at = replicas->bins + sum;
    struct running_mean chains = {0};
    for (size_t k = 0; k < replicas->count; k++)
        mf_statistics_add(&chains, replicas->member[k].counts.mean[at]);
    const double sampled =
        mf_comoments_covariance(&replicas->counts, at, at) * inefficiency / replicas->counts.count;
    return (struct replicas_mean){replicas->counts.mean[at],
                                  fmax(mf_statistics_standard_error(&chains), sqrt(sampled))};
}

double mf_replicas_acceptance(const struct replicas *replicas) {
    double sum = 0;
    for (size_t k = 0; k < replicas->count; k++)
        sum += replicas->member[k].acceptance;
    return sum / (double)replicas->count;
}

size_t mf_replicas_spans(struct replicas *replicas, struct memory_span *span) {
    size_t n = 0;
    for (size_t k = 0; k < replicas->count; k++)
        n += mf_sampler_spans(&replicas->member[k].sampler, span + n);
    return n;
}
