// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/reptation_grid.h"

#include "base/memory.h"

#include <math.h>

/// Cells along an axis at most: about one a particle, however empty the box is.
static int most_cells(size_t particles) {
    return 1 + (int)cbrt((double)particles);
}

enum status mf_reptation_grid_init(struct reptation_grid *grid, size_t particles) {
    enum status status = STATUS_OK;
    const size_t most = (size_t)most_cells(particles);
    *grid = (struct reptation_grid){0};
    NEW_ARRAY(grid->first, most * most * most);
    NEW_ARRAY(grid->next, particles);
done:
    if (status != STATUS_OK)
        mf_reptation_grid_clear(grid);
    return status;
}

void mf_reptation_grid_clear(struct reptation_grid *grid) {
    mf_memory_free(grid->first);
    mf_memory_free(grid->next);
    *grid = (struct reptation_grid){0};
}

/// Which cell along an axis has a fraction of the box.
static int cell_along(const struct reptation_grid *grid, int d, int32_t fraction) {
    return (int)((uint64_t)(uint32_t)fraction * (uint64_t)grid->cells[d] >> 32);
}

static size_t cell_number(const struct reptation_grid *grid, int a, int b, int c) {
    return ((size_t)a * (size_t)grid->cells[1] + (size_t)b) * (size_t)grid->cells[2] + (size_t)c;
}

static size_t cell_of(const struct reptation_grid *grid, const struct particles *particles,
                      int32_t k) {
    const int32_t *fraction = particles->kernel_place[k].fraction;
    return cell_number(grid, cell_along(grid, 0, fraction[0]), cell_along(grid, 1, fraction[1]),
                       cell_along(grid, 2, fraction[2]));
}

void mf_reptation_grid_fill(struct reptation_grid *grid, const struct particles *particles,
                            double cutoff) {
    size_t cells = 1;
    for (int d = 0; d < 3; d++) {
        const double fit = floor(particles->box.length[d] / cutoff);
        grid->cells[d] = (int)fmax(1, fmin(fit, most_cells(particles->count)));
        cells *= (size_t)grid->cells[d];
    }
    for (size_t cell = 0; cell < cells; cell++)
        grid->first[cell] = -1;
    for (size_t k = 0; k < particles->count; k++)
        mf_reptation_grid_insert(grid, particles, (int32_t)k);
}

void mf_reptation_grid_remove(struct reptation_grid *grid, const struct particles *particles,
                              int32_t k) {
    int32_t *link = &grid->first[cell_of(grid, particles, k)];
    while (*link != k)
        link = &grid->next[*link];
    *link = grid->next[k];
}

void mf_reptation_grid_insert(struct reptation_grid *grid, const struct particles *particles,
                              int32_t k) {
    int32_t *first = &grid->first[cell_of(grid, particles, k)];
    grid->next[k] = *first;
    *first = k;
}

/// The cells along an axis that are next to a fraction of the box, itself too, each once.
static int cells_near(const struct reptation_grid *grid, int d, int32_t fraction, int near[3]) {
    const int here = cell_along(grid, d, fraction), cells = grid->cells[d];
    const int count = cells < 3 ? cells : 3;
    for (int n = 0; n < count; n++)
        near[n] = (here + cells - 1 + n) % cells;
    return count;
}

static double square_apart(const struct particles *particles, const int32_t from[3], int32_t j) {
    const int32_t *to = particles->kernel_place[j].fraction;
    double square = 0;
    for (int d = 0; d < 3; d++) {
        const double x =
            0x1p-32 * particles->box.length[d] * box_fraction_difference(from[d], to[d]);
        square += x * x;
    }
    return square;
}

static bool is_among(const int32_t *list, int count, int32_t j) {
    for (int n = 0; n < count; n++)
        if (list[n] == j)
            return true;
    return false;
}

static double cell_energy(const struct reptation_grid *grid, size_t cell,
                          const struct pair_law *law, const struct particles *particles, int32_t k,
                          const int32_t *excluded, int count) {
    const struct particle_place *self = &particles->kernel_place[k];
    const double cutoff = law->potential->cutoff;
    const bool mixed = composition_is_mixed(&law->composition);
    double sum = 0;
    for (int32_t j = grid->first[cell]; j >= 0; j = grid->next[j]) {
        const double square = square_apart(particles, self->fraction, j);
        if (square >= cutoff * cutoff || is_among(excluded, count, j))
            continue;
        const uint32_t id = particles->kernel_place[j].id;
        const int pair = mixed ? mf_composition_pair_of_ids(&law->composition, self->id, id) : 0;
        double energy;
        mf_table_evaluate_pair(law->potential, pair, sqrt(square), &energy, NULL, NULL);
        sum += energy;
    }
    return sum;
}

double mf_reptation_grid_energy(const struct reptation_grid *grid, const struct pair_law *law,
                                const struct particles *particles, int32_t k,
                                const int32_t *excluded, int count) {
    const int32_t *fraction = particles->kernel_place[k].fraction;
    int near[3][3], cells[3];
    double sum = 0;
    for (int d = 0; d < 3; d++)
        cells[d] = cells_near(grid, d, fraction[d], near[d]);
    for (int a = 0; a < cells[0]; a++)
        for (int b = 0; b < cells[1]; b++)
            for (int c = 0; c < cells[2]; c++)
                sum += cell_energy(grid, cell_number(grid, near[0][a], near[1][b], near[2][c]), law,
                                   particles, k, excluded, count);
    return sum;
}
