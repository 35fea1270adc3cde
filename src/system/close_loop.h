// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the search for close particles, compiled for each instruction set.
#pragma once

#include "base/lanes.h"
#include "close.h"

/// Copy the particles around a cell together, so that the vectors of the search are full.
/// @param[out] own  place of the cell's first particle among them
/// @return their number
LANES_INLINE size_t close_collect(struct neighbours *neighbours, const struct particles *particles,
                                  const struct close_cell *cell, size_t *own, const int dim) {
    size_t count = 0;
    for (int r = 0; r < cell->count; r++) {
        const size_t begin = cell->run[r].begin, end = cell->run[r].end;
        if (begin <= cell->begin && cell->begin < end)
            *own = count + (cell->begin - begin);
        // Whole vectors; what is too much is overwritten by the next run.
        for (size_t k = begin; k < end; k += LANES) {
            const size_t to = count + (k - begin);
            for (int d = 0; d < dim; d++)
                lanes_store_int(neighbours->around[d] + to,
                                lanes_load_int(particles->fraction[d] + k));
            lanes_store_int(neighbours->around_index + to, (int32_t)k + lanes_number());
        }
        count += end - begin;
    }
    return count;
}

/// Append those of around[from … to − 1] that are within range of the one at `centre` to the list.
/// Two loops, first masks and then the list: together they are one long chain and take 1.7 times as
/// long.
/// @return the new length of the list
LANES_INLINE size_t close_select(struct neighbours *neighbours, size_t centre, size_t from,
                                 size_t to, const float scale[3], size_t used, const int dim) {
    // Copies of the pointers, which the stores below might change as far as a compiler knows.
    const int32_t *around[3], *index = neighbours->around_index + from;
    int32_t *list = neighbours->list;
    unsigned *masks = neighbours->around_mask;
    uint32_t x[3];
    for (int d = 0; d < dim; d++) {
        around[d] = neighbours->around[d] + from;
        x[d] = (uint32_t)neighbours->around[d][centre];
    }
    const lanes_float range2 = lanes_all((float)(neighbours->range * neighbours->range));
    const size_t count = to - from, vectors = (count + LANES - 1) / LANES;
    for (size_t v = 0; v < vectors; v++) {
        lanes_float r2 = lanes_all(0);
        for (int d = 0; d < dim; d++) {
            const lanes_uint other = (lanes_uint)lanes_load_int(around[d] + v * LANES);
            const lanes_float dx = scale[d] * lanes_to_float((lanes_int)(x[d] - other));
            r2 += dx * dx;
        }
        masks[v] = lanes_below(r2, range2);
    }
    if (count % LANES != 0)
        masks[vectors - 1] &= (1u << count % LANES) - 1;
    for (size_t v = 0; v < vectors; v++) {
        lanes_store_int(list + used, lanes_permute_int(lanes_load_int(index + v * LANES),
                                                       lanes_set_bits(masks[v])));
        used += (size_t)__builtin_popcount(masks[v]);
    }
    return used;
}

LANES_INLINE size_t close_search(struct neighbours *neighbours, const struct particles *particles,
                                 const struct close_cell *cell, size_t used, const int dim) {
    float scale[3];
    for (int d = 0; d < 3; d++)
        scale[d] = (float)(particles->box.length[d] * 0x1p-32);
    size_t own = 0;
    const size_t count = close_collect(neighbours, particles, cell, &own, dim);
    for (size_t k = cell->begin; k < cell->end; k++, own++) {
        neighbours->start[k] = used;
        if (neighbours->kind == NEIGHBOURS_FULL) {
            used = close_select(neighbours, own, 0, own, scale, used, dim);
            used = close_select(neighbours, own, own + 1, count, scale, used, dim);
            continue;
        }
        used = close_select(neighbours, own, own + 1, count, scale, used, dim);
        for (; used % NEIGHBOURS_ROW != 0; used++)
            neighbours->list[used] = (int32_t)k;
        for (size_t row = neighbours->start[k] / NEIGHBOURS_ROW; row < used / NEIGHBOURS_ROW; row++)
            neighbours->owner[row] = (int32_t)k;
    }
    return used;
}

#define CLOSE_INSTANCE(name)                                                                       \
    size_t name(struct neighbours *neighbours, const struct particles *particles,                  \
                const struct close_cell *cell, size_t used) {                                      \
        return particles->box.dimensions == 2                                                      \
                   ? close_search(neighbours, particles, cell, used, 2)                            \
                   : close_search(neighbours, particles, cell, used, 3);                           \
    }
