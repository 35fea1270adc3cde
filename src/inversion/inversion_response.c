// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_response.h"

#include "base/memory.h"
#include "inversion/inversion_covariance.h"
#include "inversion/inversion_state.h"

#include <math.h>
#include <string.h>

enum status mf_inversion_response_init(struct inversion_state *state) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &state->grid;
    struct inversion_response *response = &state->response;
    size_t size = 0;
    NEW_ARRAY(response->sampled, grid->known * grid->known);
    NEW_ARRAY(response->covariance, grid->known * grid->known);
    NEW_ARRAY(response->shared, grid->known);
    NEW_ARRAY(response->mean, grid->known);
    NEW_ARRAY(response->phi, grid->known);
    if (mf_inversion_bulk_kind(state) == TARGET_DENSITY) {
        NEW_ARRAY(response->of_density, grid->known);
        NEW_ARRAY(response->density, grid->known);
    }
    if (response->density || grid->groups > 0)
        NEW_ARRAY(response->values, grid->known * grid->known);
    if (grid->groups == 0)
        return STATUS_OK;
    for (size_t g = 0; g < grid->groups; g++)
        size += grid->group[g].own.known * grid->group[g].own.known;
    NEW_ARRAY(response->means, size);
    double *means = response->means;
    for (size_t g = 0; g < grid->groups; g++) {
        const struct bonded_grid *own = &grid->group[g].own;
        CHECK(mf_bonded_grid_means(own, means));
        means += own->known * own->known;
    }
done:
    return status;
}

void mf_inversion_response_clear(struct inversion_response *response) {
    mf_memory_free(response->means);
    mf_memory_free(response->of_density);
    mf_memory_free(response->density);
    mf_memory_free(response->values);
    mf_memory_free(response->mean);
    mf_memory_free(response->phi);
    mf_memory_free(response->sampled);
    mf_memory_free(response->covariance);
    mf_memory_free(response->shared);
    *response = (struct inversion_response){0};
}

/// A row of the response, from one of C.
static void respond(const struct inversion_state *state, const double *c, double *row) {
    const struct potential_grid *grid = &state->grid;
    const double *means = state->response.means;
    size_t first = grid->pairs_known;
    memcpy(row, c, first * sizeof *row);
    for (size_t g = 0; g < grid->groups; g++) {
        const size_t own = grid->group[g].own.known;
        for (size_t b = 0; b < own; b++) {
            row[first + b] = 0;
            for (size_t k = 0; k < own; k++)
                row[first + b] += c[first + k] * means[k * own + b];
        }
        first += own;
        means += own * own;
    }
}

/// What the potential of pairs does to g by the density.
static void add_density(const struct inversion_state *state, size_t a, double *row) {
    const struct inversion_response *response = &state->response;
    const double w = state->replicas.counts.mean[state->bins + SAMPLER_DENSITY];
    for (size_t b = 0; b < state->grid.pairs_known; b++)
        row[b] = w * row[b] + response->mean[b] * response->density[a];
}

void mf_inversion_response_find(struct inversion_state *state) {
    const size_t known = state->grid.known;
    if (state->response.values == NULL)
        return;
    for (size_t a = 0; a < known; a++) {
        double *row = state->response.values + a * known;
        respond(state, state->response.covariance + a * known, row);
        if (state->response.density)
            add_density(state, a, row);
    }
}

const double *mf_inversion_response_values(const struct inversion_state *state) {
    return state->response.values ? state->response.values : state->response.covariance;
}

/// How far the variance of S along the way from the potentials of C to the present one is another
/// than C says: the square of its relative change, but for noise. Of n independent samples a
/// variance has the relative variance 2/n.
static double find_change_along_step(const struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    const struct inversion_response *response = &state->response;
    const struct comoments *counts = &state->replicas.counts;
    double before = 0, now = 0;
    for (size_t a = 0; a < grid->known; a++)
        for (size_t b = 0; b < grid->known; b++) {
            const double change = (state->phi[grid->known_point[a]] - response->phi[a]) *
                                  (state->phi[grid->known_point[b]] - response->phi[b]);
            before += change * response->sampled[a * grid->known + b];
            now += change * mf_comoments_covariance(counts, grid->known_bin[a], grid->known_bin[b]);
        }
    if (!(before > 0 && now > 0))
        return 0;
    const double noise = 2 / response->independent + 2 * state->inefficiency / counts->count;
    return fmax(0, pow(before / now - 1, 2) - noise);
}

/// The independent samples at the present potential that the C of before is worth. Of n of them C
/// of N functions has the relative variance N/n as a matrix. Where g has changed by δ it is off by
/// 2 δ, as a product of two counts is; and where a fit goes by what g hardly sees, C changes along
/// its way though g does not: of a Yukawa fluid the variance along it fell to a third while g moved
/// by 0.002. With that C of before the fit ended at a pressure of 11.3(2.2) instead of 19.0,
/// without it at 15.4(5.3).
///
/// Samples as such would not do: how many make one independent is another number in each iteration,
/// as is what lies between them.
static double find_worth(const struct inversion_state *state) {
    const struct inversion_response *response = &state->response;
    const double known = (double)state->grid.known, functions = (double)response->functions;
    double squares = 0;
    for (size_t a = 0; a < state->grid.known; a++) {
        const size_t bin = state->grid.known_bin[a];
        squares += pow(
            (state->replicas.counts.mean[bin] - response->mean[a]) / state->target.ideal[bin], 2);
    }
    const double change = 4 * squares / known + find_change_along_step(state);
    return response->independent > 0 ? 1 / (1 / response->independent + change / functions) : 0;
}

enum status mf_inversion_response_add(struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    const struct comoments *counts = &state->replicas.counts;
    struct inversion_response *response = &state->response;
    const double now = counts->count / state->inefficiency;
    response->independent = find_worth(state) + now;
    const double share = now / response->independent;
    const size_t density = state->bins + SAMPLER_DENSITY;
    const struct inversion_covariance_density with = {
        response->of_density, mf_comoments_covariance(counts, density, density), response->density};
    for (size_t a = 0; a < grid->known; a++) {
        const size_t bin = grid->known_bin[a];
        for (size_t b = 0; b < grid->known; b++) {
            double *c = &response->sampled[a * grid->known + b];
            *c =
                (1 - share) * *c + share * mf_comoments_covariance(counts, bin, grid->known_bin[b]);
        }
        response->mean[a] = (1 - share) * response->mean[a] + share * counts->mean[bin];
        if (response->of_density)
            response->of_density[a] = (1 - share) * response->of_density[a] +
                                      share * mf_comoments_covariance(counts, bin, density);
        response->phi[a] =
            (1 - share) * response->phi[a] + share * state->phi[grid->known_point[a]];
    }
    TRY(mf_inversion_covariance_find(
        &(struct inversion_covariance_blocks){grid->known_of, grid->blocks, grid->known},
        response->sampled, response->mean, response->independent, response->covariance,
        response->shared, &response->functions, response->density ? &with : NULL));
    mf_inversion_response_find(state);
    mf_inversion_kirkwood_buff_respond(state, share);
    return STATUS_OK;
}

enum status mf_inversion_response_assess(struct inversion_state *state) {
    mf_inversion_bulk_measure(state);
    TRY(mf_inversion_response_add(state));
    return mf_inversion_bulk_slopes(state);
}
