// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the samples' own scatter along what g hardly sees adds to the band.
#include "base/statistics.h"
#include "inversion/inversion.h"

#include <math.h>
#include <string.h>

/// Variances of the mean of a number Σ q_a S_a over the samples.
struct scatter {
    double expected; ///< by the covariance of S and the inefficiency of its bins
    double found;    ///< by the scatter of replicas, and of the parts of their samples
    double slowness; ///< samples that count as one independent
};

/// What S weighs, q·S, of part p of `parts` of replica k.
static double find_part(const struct inversion_state *state, const double *q, size_t k, size_t p,
                        size_t parts) {
    const size_t length = REPLICAS_BLOCKS / parts;
    const struct replicas *replicas = &state->replicas;
    double sum = 0;
    for (size_t b = p * length; b < (p + 1) * length; b++)
        for (size_t a = 0; a < state->grid.known; a++)
            sum += q[a] *
                   (replicas->member[k].block[b * replicas->numbers + state->grid.known_bin[a]] -
                    replicas->counts.mean[state->grid.known_bin[a]]);
    return sum / (double)length;
}

/// Variance of the mean of all samples by that of the means of so many parts of each replica's.
static double find_variance(const struct inversion_state *state, const double *q, size_t parts) {
    struct running_mean means = {0};
    for (size_t k = 0; k < state->replicas.count; k++)
        for (size_t p = 0; p < parts; p++)
            mf_statistics_add(&means, find_part(state, q, k, p, parts));
    return pow(mf_statistics_standard_error(&means), 2);
}

static struct scatter find_scatter(const struct inversion_state *state, const double *q) {
    const struct comoments *counts = &state->replicas.counts;
    const size_t n = state->grid.known, *bin = state->grid.known_bin;
    double each = 0, expected = 0;
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++) {
            const double term = q[a] * q[b] * mf_comoments_covariance(counts, bin[a], bin[b]);
            each += term;
            expected += term * sqrt(state->bin_inefficiency[a] * state->bin_inefficiency[b]);
        }
    const double found = fmax(find_variance(state, q, 1), find_variance(state, q, REPLICAS_BLOCKS));
    return (struct scatter){expected / counts->count, found,
                            each > 0 ? found * counts->count / each : 1};
}

/// By how much less the present samples scatter together with those before them.
static double pooled(const struct inversion_state *state) {
    const double now = state->replicas.counts.count;
    return state->pool.samples > 0 ? fmin(1, now / state->pool.samples) : 1;
}

/// What was added to Σ, factor u uᵀ each.
struct added {
    size_t count;
    double *u[1 + INVERSE_MAX_STATES], factor[1 + INVERSE_MAX_STATES];
    double slowness[INVERSE_MAX_STATES]; ///< of the slowest number in each state
    double *q; ///< how S of each state weighs in the last number, shape [states, known]
};

static double product(const double *a, const double *b, size_t n) {
    double sum = 0;
    for (size_t k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

/// The variance that the samples make of v·step, and what of it is not in Σ.
struct by_samples {
    double all, more;
};

static enum status find_by_samples(struct inversion *inversion, double birge, const double *v,
                                   struct added *added, struct by_samples *found) {
    enum status status = STATUS_OK;
    const size_t n = inversion_grid(inversion)->known;
    double *x = NULL;
    NEW_ARRAY(x, n);
    for (size_t a = 0; a < n; a++)
        x[a] = product(inversion->course.band.inverse + a * n, v, n) / birge;
    *found = (struct by_samples){0};
    for (size_t s = 0; s < inversion->equations.states; s++) {
        const struct inversion_state *state = &inversion->state[s];
        double *q = added->q + s * n;
        mf_inversion_equations_weigh(&inversion->equations, s, x, q);
        const struct scatter scatter = find_scatter(state, q);
        added->slowness[s] = fmax(added->slowness[s], scatter.slowness);
        found->all += fmax(scatter.found, birge * scatter.expected) * pooled(state);
        found->more += (scatter.found - birge * scatter.expected) * pooled(state);
    }
    for (size_t k = 0; k < added->count; k++)
        found->more -= added->factor[k] * pow(product(added->u[k], v, n), 2);
done:
    mf_memory_free(x);
    return status;
}

/// Σ ← Σ + more/(v·Σ v)² Σ v (Σ v)ᵀ.
/// @param[out] rest  v·Σ v after that, but for the samples
static enum status add(struct inversion *inversion, const double *v, const struct by_samples *found,
                       struct added *added, double *rest) {
    enum status status = STATUS_OK;
    const size_t n = inversion_grid(inversion)->known;
    double *u = NULL;
    NEW_ARRAY(u, n);
    for (size_t a = 0; a < n; a++)
        u[a] = product(inversion->course.band.covariance + a * n, v, n);
    const double before = product(u, v, n), more = fmax(0, found->more);
    *rest = fmax(0, before + more - found->all);
    added->factor[added->count] = before > 0 ? more / (before * before) : 0;
    added->u[added->count] = u;
    if (before > 0) // not of a ramp without bins
        mf_inversion_band_add_square(inversion, added->factor[added->count], u);
    added->count++;
done:
    return status;
}

/// Keep the number of which the samples tell least beside what else is known of it.
static void keep_noisiest(struct inversion *inversion, const struct added *added, double samples,
                          double rest) {
    const size_t n = inversion_grid(inversion)->known;
    const struct inversion_state *first = inversion->state;
    if (added->count > 1 && !(samples * first->open.rest > first->open.samples * rest))
        return;
    for (size_t s = 0; s < inversion->states; s++) {
        struct inversion_state *state = &inversion->state[s];
        memcpy(state->open.weight, added->q + s * n, n * sizeof(double));
        state->open.samples = samples;
        state->open.rest = rest;
    }
}

/// One number, of slope v.
/// @param[out] samples  its standard error by them
static enum status add_number(struct inversion *inversion, double birge, const double *v,
                              struct added *added, double *samples) {
    struct by_samples found;
    double rest;
    TRY(find_by_samples(inversion, birge, v, added, &found));
    TRY(add(inversion, v, &found, added, &rest));
    *samples = sqrt(found.all);
    keep_noisiest(inversion, added, *samples, sqrt(rest));
    return STATUS_OK;
}

enum status mf_inversion_band_add_samples(struct inversion *inversion, double birge,
                                          const double *weight) {
    enum status status = STATUS_OK;
    struct added added = {0};
    double ramp, bulk[INVERSE_MAX_STATES] = {0};
    if (inversion_grid(inversion)->pairs == 0 || inversion->state->basis.count > 0)
        return STATUS_OK;
    NEW_ARRAY(added.q, inversion->states * inversion_grid(inversion)->known);
    CHECK(add_number(inversion, birge, weight, &added, &ramp));
    for (size_t s = 0; s < inversion->states; s++)
        CHECK(add_number(inversion, birge, inversion->state[s].bulk.slope, &added, &bulk[s]));
    inversion->course.band.ramp.bulk_samples = bulk[0];
    for (size_t s = 0; s < inversion->states; s++) {
        struct inversion_state *state = &inversion->state[s];
        state->open.independent = state->replicas.counts.count / fmax(1, added.slowness[s]);
        state->work.memory *= fmax(1, added.slowness[s] / state->inefficiency);
    }
done:
    for (size_t k = 0; k < added.count; k++)
        mf_memory_free(added.u[k]);
    mf_memory_free(added.q);
    return status;
}

/// Whether what so many independent samples scatter by is not known well enough for a number of
/// which they leave as much open as matters beside all else. What each replica has seen but once or
/// twice may still be where it began.
static bool is_seen_too_seldom(const struct inversion_state *state, double samples,
                               double independent) {
    static const double each = 3, matters = 0.5;
    return samples > matters * state->open.rest &&
           independent < each * (double)state->replicas.count;
}

bool mf_inversion_band_is_noisy(const struct inversion_state *state) {
    static const double enough = 1.5; // the noise of what is found is a fourth of it
    const double samples = state->open.samples;
    return samples > enough * state->open.rest ||
           is_seen_too_seldom(state, samples, state->open.independent);
}

struct inverse_doubling mf_inversion_band_noise(const struct inversion_state *state) {
    const double now = state->replicas.counts.count;
    if (!(state->open.rest > 0))
        return (struct inverse_doubling){.wanted = 1, .unit = ""};
    const struct scatter scatter = find_scatter(state, state->open.weight);
    const double noise = sqrt(scatter.found * now / (now + state->pool.samples));
    const double ratio = noise / state->open.rest;
    const bool seldom = is_seen_too_seldom(state, noise, now / fmax(1, scatter.slowness));
    const double doubled = ratio / sqrt(2); // by twice the samples
    return (struct inverse_doubling){
        .noise = ratio, .wanted = seldom ? fmin(1, doubled) : 1, .unit = ""};
}
