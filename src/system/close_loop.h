// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the search for close particles, compiled for each instruction set.
#pragma once

#include "base/lanes.h"
#include "close.h"

/// By how much squared distances may be too large in single precision, relative to the range: nine
/// roundings of 6e-8, and half a unit of either fraction, which is 1e-6 if the box is 2000 times as
/// long as the range. Without it a list with no skin would lack a pair at the very cutoff, which
/// kernels in double precision would notice.
static const double wider = 2e-6;

/// What stays the same from particle to particle. Passed by value, so that the stores to the list
/// cannot change it as far as a compiler knows.
struct close_search {
    const int32_t *x, *y, *z; ///< fractions of the box
    lanes_real scale[3];      ///< box edges in units of 2³²: fractions to lengths
    lanes_real range2;
};

/// Write those of the particles begin … end − 1 that are within range of particle k to `list`.
/// Whole vectors are read and written, also beyond the end; one at least, since runs are rarely
/// empty.
/// @return the end of what was written
LANES_INLINE int32_t *close_select(const struct close_search search, size_t k, size_t begin,
                                   size_t end, int32_t *list, const int dim) {
    const int32_t x = search.x[k], y = search.y[k], z = dim == 3 ? search.z[k] : 0;
    do {
        // Differences of unsigned fractions wrap around (box_fraction).
        const lanes_real dx =
            search.scale[0] * lanes_to_real(lanes_difference(x, search.x + begin));
        const lanes_real dy =
            search.scale[1] * lanes_to_real(lanes_difference(y, search.y + begin));
        lanes_real r2 = dx * dx + dy * dy;
        if (dim == 3) {
            const lanes_real dz =
                search.scale[2] * lanes_to_real(lanes_difference(z, search.z + begin));
            r2 += dz * dz;
        }
        const unsigned mask = lanes_below(r2, search.range2) & lanes_first(end - begin);
        lanes_store_int(list, (int32_t)begin + lanes_set_bits(mask));
        list += __builtin_popcount(mask);
        begin += LANES;
    } while (begin < end);
    return list;
}

/// Fill the last row of particle k with itself, and say whose its rows are.
/// @return the end of its rows
LANES_INLINE size_t close_fill_rows(struct neighbours *neighbours, size_t k, size_t begin,
                                    size_t used) {
    lanes_store_int(neighbours->list + used, lanes_all_int((int32_t)k));
    if (LANES < NEIGHBOURS_ROW)
        lanes_store_int(neighbours->list + used + LANES, lanes_all_int((int32_t)k));
    const size_t end = (used + NEIGHBOURS_ROW - 1) / NEIGHBOURS_ROW * NEIGHBOURS_ROW;
    // Whole vectors: rows beyond the end are written again by the next particle.
    for (size_t row = begin / NEIGHBOURS_ROW; row < end / NEIGHBOURS_ROW; row += LANES)
        lanes_store_int(neighbours->owner + row, lanes_all_int((int32_t)k));
    return end;
}

/// The neighbours of particle k in a half list: those behind it in the first run, and in the
/// others.
LANES_INLINE int32_t *close_half(const struct close_search search, const struct close_cell *cell,
                                 size_t k, int32_t *list, const int dim) {
    list = close_select(search, k, k + 1, cell->run[0].end, list, dim);
    for (int r = 1; r < cell->count; r++)
        list = close_select(search, k, cell->run[r].begin, cell->run[r].end, list, dim);
    return list;
}

/// The neighbours of particle k in a full list: all but itself.
LANES_INLINE int32_t *close_full(const struct close_search search, const struct close_cell *cell,
                                 size_t k, int32_t *list, const int dim) {
    for (int r = 0; r < cell->count; r++) {
        const struct close_run run = cell->run[r];
        const bool has_own = run.begin <= k && k < run.end;
        list = close_select(search, k, run.begin, has_own ? k : run.end, list, dim);
        if (has_own)
            list = close_select(search, k, k + 1, run.end, list, dim);
    }
    return list;
}

LANES_INLINE size_t close_loop(struct neighbours *neighbours, const struct particles *particles,
                               const struct close_cell *cell, size_t used, size_t limit,
                               const int dim, const bool half) {
    struct close_search search = {
        .x = particles->fraction[0],
        .y = particles->fraction[1],
        .z = particles->fraction[2],
        .range2 = lanes_all((float)(neighbours->range * neighbours->range * (1 + wider))),
    };
    for (int d = 0; d < 3; d++)
        search.scale[d] = lanes_all((float)(particles->box.length[d] * 0x1p-32));
    int32_t *const list = neighbours->list;
    for (size_t k = cell->begin; k < cell->end; k++) {
        if (used + cell->around + 2 * PARTICLES_PADDING > limit)
            return SIZE_MAX;
        neighbours->start[k] = used;
        const int32_t *end = half ? close_half(search, cell, k, list + used, dim)
                                  : close_full(search, cell, k, list + used, dim);
        used = (size_t)(end - list);
        if (half)
            used = close_fill_rows(neighbours, k, neighbours->start[k], used);
        neighbours->stop[k] = used;
    }
    return used;
}

#define CLOSE_INSTANCE(name)                                                                       \
    size_t name(struct neighbours *neighbours, const struct particles *particles,                  \
                const struct close_cell *cell, size_t used, size_t limit) {                        \
        const bool half = neighbours->kind == NEIGHBOURS_HALF;                                     \
        if (particles->box.dimensions == 2)                                                        \
            return close_loop(neighbours, particles, cell, used, limit, 2, half);                  \
        return half ? close_loop(neighbours, particles, cell, used, limit, 3, true)                \
                    : close_loop(neighbours, particles, cell, used, limit, 3, false);              \
    }
