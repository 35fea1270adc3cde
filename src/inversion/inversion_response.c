// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_response.h"

#include "base/memory.h"
#include "inversion/inversion.h"

#include <string.h>

enum status mf_inversion_response_init(struct inversion *inversion) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &inversion->grid;
    struct inversion_response *response = &inversion->response;
    size_t size = 0;
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
    *response = (struct inversion_response){0};
}

/// A row of the response, from one of C.
static void respond(const struct inversion *inversion, const double *c, double *row) {
    const struct potential_grid *grid = &inversion->grid;
    const double *means = inversion->response.means;
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

void mf_inversion_response_find(struct inversion *inversion) {
    const size_t known = inversion->grid.known;
    if (inversion->response.values == NULL)
        return;
    for (size_t a = 0; a < known; a++)
        respond(inversion, inversion->covariance + a * known,
                inversion->response.values + a * known);
}

const double *mf_inversion_response_values(const struct inversion *inversion) {
    return inversion->response.values ? inversion->response.values : inversion->covariance;
}
