// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The one body of the search for close particles, compiled for each instruction set.
#pragma once

#include "base/lanes.h"
#include "pair_search.h"

/// By how much distances may be too large in single precision, relative to the longest edge of the
/// box: places up to twice as long are rounded four times to 24 bits. Without it a list with no
/// skin would lack a pair at the very cutoff.
static const double wider = 2e-6;

/// What stays the same from particle to particle. Passed by value, so that the stores to the list
/// cannot change it as far as a compiler knows.
struct pair_search {
    const float *place[3];
    const int32_t *particle;
    float length[3], inverse_length[3]; ///< the latter is 0 where images need not be looked for
    float range2;
};

/// Places of the list that the rows of a particle may reach beyond its neighbours: a vector of
/// entries, the rest of a row, and a vector of owners, each of a whole row. All of them must be
/// before the next part, which another thread may have filled already.
enum { PAIR_SEARCH_BEYOND = 2 * PARTICLES_PADDING + LANES * NEIGHBOURS_ROW };

/// Write those of a run that are within range of a place to `list`. Whole vectors are read, also
/// beyond the end, where nothing is in range (or belongs to the run as well), and written; one at
/// least, since runs are rarely empty.
/// @param[in] self  place to be left out of a full list
/// @return the end of what was written
LANES_INLINE int32_t *search_select(const struct pair_search search, const lanes_real from[3],
                                    size_t begin, size_t end, size_t self, int32_t *list,
                                    const int dim, const bool wrap, const bool half) {
    do {
        lanes_real r2 = lanes_all(0);
        for (int d = 0; d < dim; d++) {
            lanes_real x = from[d] - lanes_load(search.place[d] + begin);
            if (wrap)
                x -= search.length[d] * lanes_nearest(search.inverse_length[d] * x);
            r2 += x * x;
        }
        unsigned mask = lanes_below(r2, lanes_all(search.range2));
        if (!half && self - begin < LANES)
            mask &= ~(1u << (self - begin));
        lanes_store_int(
            list, lanes_permute_int(lanes_load_int(search.particle + begin), lanes_set_bits(mask)));
        list += __builtin_popcount(mask);
        begin += LANES;
    } while (begin < end);
    return list;
}

/// Fill the last row of particle k with itself, and say whose its rows are.
/// @return the end of its rows
LANES_INLINE size_t search_fill_rows(struct neighbours *neighbours, size_t k, size_t begin,
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

/// Places around a cell, a run from each row. In a half list the first begins with the cell itself;
/// the others are wanted whole.
struct pair_search_runs {
    uint32_t begin[PAIR_SEARCH_MAX_ROWS], end[PAIR_SEARCH_MAX_ROWS];
    size_t places; ///< in all of them
};

LANES_INLINE void search_find_runs(struct pair_search_runs *runs,
                                   const struct pair_search_rows *rows, int cell, const bool half) {
    const int lowest = -rows->margin, highest = rows->cells + rows->margin;
    runs->places = 0;
    for (int r = 0; r < rows->count; r++) {
        const struct pair_search_row *row = &rows->row[r];
        const int first = cell - row->depth, last = cell + row->depth + 1;
        runs->begin[r] = row->start[first > lowest ? first : lowest];
        runs->end[r] = row->start[last < highest ? last : highest];
        runs->places += runs->end[r] - runs->begin[r];
    }
    if (half)
        runs->begin[0] = rows->row[0].start[cell];
}

/// The neighbours of the particle at a place: in a half list those after it in the first run, and
/// in the others; in a full list all but itself.
LANES_INLINE int32_t *search_around(const struct pair_search search,
                                    const struct pair_search_rows *rows,
                                    const struct pair_search_runs *runs, size_t self, int32_t *list,
                                    const int dim, const bool wrap, const bool half) {
    const lanes_real x = lanes_all(search.place[0][self]), y = lanes_all(search.place[1][self]);
    const lanes_real z = dim == 3 ? lanes_all(search.place[2][self]) : x;
    const lanes_real here[3] = {x, y, z};
    list = search_select(search, here, half ? self + 1 : runs->begin[0], runs->end[0], self, list,
                         dim, wrap, half);
    for (int r = 1; r < rows->count; r++) {
        const float *shift = rows->row[r].shift;
        const lanes_real from[3] = {x - shift[0], y - shift[1], z};
        list =
            search_select(search, from, runs->begin[r], runs->end[r], self, list, dim, wrap, half);
    }
    return list;
}

/// Take those out of the neighbours of particle k that molecules exclude. Whole vectors are read
/// and written, as by search_select, without asking where an excluded one is: no branch to be
/// mistaken.
/// @return the end of what is left
LANES_INLINE int32_t *search_exclude(const struct particles *particles, size_t k, int32_t *list,
                                     const int32_t *end) {
    const struct topology *topology = particles->topology;
    const uint32_t id = particles->id[k];
    for (const int32_t *next = list; next < end; next += LANES) {
        const lanes_int entries = lanes_load_int(next);
        lanes_int excluded = lanes_all_int(0); // −1 in the lanes where it is
        for (size_t n = topology->excluded_start[id]; n < topology->excluded_start[id + 1]; n++)
            excluded |= entries == lanes_all_int((int32_t)particles->place[topology->excluded[n]]);
        unsigned left = ~lanes_below(lanes_to_real(excluded), lanes_all(0));
        left &= end - next < LANES ? (1u << (end - next)) - 1 : (1u << LANES) - 1;
        lanes_store_int(list, lanes_permute_int(entries, lanes_set_bits(left)));
        list += __builtin_popcount(left);
    }
    return list;
}

LANES_INLINE struct pair_search search_prepare(const struct neighbours *neighbours,
                                               const struct box *box) {
    const double range = neighbours->range + wider * mf_box_longest(box);
    struct pair_search search = {.particle = neighbours->rows.particle,
                                 .range2 = (float)(range * range)};
    for (int d = 0; d < 3; d++) {
        search.place[d] = neighbours->rows.place[d];
        search.length[d] = (float)box->length[d];
        search.inverse_length[d] = neighbours_span_axis(neighbours, d) ? 1 / search.length[d] : 0;
    }
    return search;
}

LANES_INLINE size_t pair_search_loop(struct neighbours *neighbours,
                                     const struct particles *particles,
                                     const struct pair_search_rows *rows, size_t used, size_t limit,
                                     const int dim, const bool wrap, const bool half) {
    const struct pair_search search = search_prepare(neighbours, &particles->box);
    const uint32_t *const start = rows->row[0].start;
    const bool excludes = particles->topology && particles->topology->excludes;
    int32_t *const list = neighbours->list;
    struct pair_search_runs runs;
    size_t k = rows->first;
    for (int cell = 0; cell < rows->cells; cell++) {
        search_find_runs(&runs, rows, cell, half);
        for (size_t self = start[cell]; self < start[cell + 1]; self++, k++) {
            if (used + runs.places + PAIR_SEARCH_BEYOND > limit)
                return SIZE_MAX;
            neighbours->start[k] = used;
            int32_t *end = search_around(search, rows, &runs, self, list + used, dim, wrap, half);
            if (excludes)
                end = search_exclude(particles, k, list + used, end);
            used = (size_t)(end - list);
            if (half)
                used = search_fill_rows(neighbours, k, neighbours->start[k], used);
            neighbours->stop[k] = used;
        }
    }
    return used;
}

#define PAIR_SEARCH_INSTANCE(name)                                                                 \
    size_t name(struct neighbours *neighbours, const struct particles *particles,                  \
                const struct pair_search_rows *rows, size_t used, size_t limit) {                  \
        const bool half = neighbours->kind == NEIGHBOURS_HALF;                                     \
        if (particles->box.dimensions == 2)                                                        \
            return pair_search_loop(neighbours, particles, rows, used, limit, 2, true, half);      \
        if (neighbours->rows.wrap)                                                                 \
            return pair_search_loop(neighbours, particles, rows, used, limit, 3, true, half);      \
        return half ? pair_search_loop(neighbours, particles, rows, used, limit, 3, false, true)   \
                    : pair_search_loop(neighbours, particles, rows, used, limit, 3, false, false); \
    }
