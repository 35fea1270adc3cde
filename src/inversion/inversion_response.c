// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_response.h"

#include "base/memory.h"
#include "inversion/inversion_state.h"

#include <string.h>

enum status mf_inversion_response_init(struct inversion_state *state) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &state->grid;
    struct inversion_response *response = &state->response;
    size_t size = 0;
    NEW_ARRAY(response->covariance, grid->known * grid->known);
    if (grid->groups == 0)
        return STATUS_OK;
    for (size_t g = 0; g < grid->groups; g++)
        size += grid->group[g].own.known * grid->group[g].own.known;
    NEW_ARRAY(response->means, size);
    NEW_ARRAY(response->values, grid->known * grid->known);
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
    mf_memory_free(response->values);
    mf_memory_free(response->covariance);
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

void mf_inversion_response_find(struct inversion_state *state) {
    const size_t known = state->grid.known;
    if (state->response.values == NULL)
        return;
    for (size_t a = 0; a < known; a++)
        respond(state, state->response.covariance + a * known, state->response.values + a * known);
}

const double *mf_inversion_response_values(const struct inversion_state *state) {
    return state->response.values ? state->response.values : state->response.covariance;
}

/// C of the present samples, and near the target of all since it was reached. The noise of C leads
/// from every direction into those that g sees best, so that little seen ones seem better known
/// than they are and each step goes a part of their way: a third for soft beads with 1400 samples
/// and as many again in the target, where the pressure was still off by three of its errors
/// when g had agreed.
static void assess_covariance(struct inversion_state *state) {
    const struct potential_grid *grid = &state->grid;
    const struct comoments *counts = &state->replicas.counts;
    const bool near = mf_inversion_state_is_near(state);
    const double before = near ? state->response.kept : 0;
    const double share = counts->count / (before + counts->count);
    state->response.samples = before + counts->count;
    for (size_t a = 0; a < grid->known; a++)
        for (size_t b = 0; b < grid->known; b++) {
            double *c = &state->response.covariance[a * grid->known + b];
            const double now =
                mf_comoments_covariance(counts, grid->known_bin[a], grid->known_bin[b]);
            *c = (1 - share) * *c + share * now;
        }
    mf_inversion_response_find(state);
    mf_inversion_kirkwood_buff_respond(state, share);
    state->response.kept = near ? state->response.samples : 0;
}

enum status mf_inversion_response_assess(struct inversion_state *state) {
    mf_inversion_pressure_measure(state);
    assess_covariance(state);
    return mf_inversion_pressure_slopes(state);
}
