// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "neighbours_build.h"
#include "pair_search.h"

#include <stdlib.h>

enum { WIDEST = 2 * NEIGHBOURS_MAX_RANGE_CELLS + 1 };
_Static_assert(PAIR_SEARCH_MAX_ROWS >= WIDEST * WIDEST, "rows in range");

// Rows --------------------------------------------------------------------------------------------

/// Vectors of the search may read so far beyond the end of a row: it ends with places that are
/// nowhere near anything.
enum { ROW_PADDING = PARTICLES_PADDING };

static size_t row_count(const struct neighbours *neighbours) {
    return (size_t)neighbours->cells.count[0] * (size_t)neighbours->cells.count[1];
}

enum status mf_neighbours_init_rows(struct neighbours *neighbours, const struct box *box) {
    struct neighbours_rows *rows = &neighbours->rows;
    rows->wrap = false;
    for (int d = 0; d < box->dimensions; d++)
        rows->wrap |= neighbours_span_axis(neighbours, d);
    rows->margin = neighbours_span_axis(neighbours, 2) ? 0 : neighbours->range_cells[2];
    const size_t images = rows->margin > 0 ? 2 * neighbours->count : 0;
    const size_t capacity = neighbours->count + images + row_count(neighbours) * ROW_PADDING;
    // There is room for images of all particles: most of it is never touched.
    for (int d = 0; d < box->dimensions; d++) {
        rows->place[d] = mf_memory_uncleared(capacity, sizeof *rows->place[d]);
        if (rows->place[d] == NULL)
            return STATUS_NO_MEMORY;
    }
    rows->particle = mf_memory_uncleared(capacity, sizeof *rows->particle);
    if (rows->particle == NULL)
        return STATUS_NO_MEMORY;
    rows->cells = (size_t)(neighbours->cells.count[2] + 2 * rows->margin);
    TRY_ARRAY(rows->start, row_count(neighbours) * (rows->cells + 1));
    return STATUS_OK;
}

void mf_neighbours_clear_rows(struct neighbours *neighbours) {
    struct neighbours_rows *rows = &neighbours->rows;
    for (int d = 0; d < 3; d++)
        mf_memory_free(rows->place[d]);
    mf_memory_free(rows->particle);
    mf_memory_free(rows->start);
}

/// Lay out the rows one after the other.
static void place_rows(struct neighbours *neighbours) {
    struct neighbours_rows *rows = &neighbours->rows;
    const int n = neighbours->cells.count[2];
    const uint32_t *cell_start = neighbours->cells.start;
    uint32_t *start = rows->start, at = 0;
    for (size_t row = 0; row < row_count(neighbours); row++) {
        for (int c = -rows->margin; c < n + rows->margin; c++) {
            const int cell = c < 0 ? c + n : c < n ? c : c - n;
            *start++ = at;
            at += cell_start[cell + 1] - cell_start[cell];
        }
        *start++ = at;
        at += ROW_PADDING;
        cell_start += n;
    }
}

struct filling {
    struct neighbours *neighbours;
    const struct particles *particles;
};

/// Copy particles first … last − 1 to place `at`, moved along the last axis by `shift`.
static void copy_stretch(const struct neighbours_rows *rows, const struct particles *particles,
                         size_t first, size_t last, size_t at, float shift) {
    const int dimensions = particles->box.dimensions;
    for (int d = 0; d < dimensions; d++) {
        const float scale = (float)(particles->box.length[d] * 0x1p-32);
        const float offset = d == 2 ? shift : 0;
        const int32_t *restrict fraction = particles->fraction[d] + first;
        float *restrict place = rows->place[d] + at;
        for (size_t k = 0; k < last - first; k++)
            place[k] = scale * (float)(uint32_t)fraction[k] + offset;
    }
    int32_t *restrict particle = rows->particle + at;
    for (size_t k = 0; k < last - first; k++)
        particle[k] = (int32_t)(first + k);
}

SIMD_CLONES static void fill_rows(void *context, size_t begin, size_t end) {
    const struct filling *filling = context;
    const struct neighbours *neighbours = filling->neighbours;
    const struct neighbours_rows *rows = &neighbours->rows;
    const size_t n = (size_t)neighbours->cells.count[2], margin = (size_t)rows->margin;
    const float length = (float)filling->particles->box.length[2];
    for (size_t row = begin; row < end; row++) {
        const uint32_t *cell_start = neighbours->cells.start + row * n;
        const uint32_t *start = rows->start + row * (rows->cells + 1);
        copy_stretch(rows, filling->particles, cell_start[n - margin], cell_start[n], start[0],
                     -length);
        copy_stretch(rows, filling->particles, cell_start[0], cell_start[n], start[margin], 0);
        copy_stretch(rows, filling->particles, cell_start[0], cell_start[margin], start[margin + n],
                     length);
        for (size_t k = 0; k < ROW_PADDING; k++)
            rows->place[0][start[rows->cells] + k] = INFINITY;
    }
}

/// Copy sorted particles into the rows.
static void neighbours_fill_rows(struct neighbours *neighbours, const struct particles *particles) {
    struct filling filling = {neighbours, particles};
    place_rows(neighbours);
    mf_parallel_for(row_count(neighbours), particles->threads, fill_rows, &filling);
}

// Sorting -----------------------------------------------------------------------------------------

struct sorting {
    struct cells *cells;
    const struct particles *particles;
};

SIMD_CLONES static void find_cells_of(void *context, size_t begin, size_t end) {
    const struct sorting *sorting = context;
    const struct particles *particles = sorting->particles;
    uint32_t *restrict of = sorting->cells->of;
    memset(of + begin, 0, (end - begin) * sizeof *of);
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double inverse_length = 1 / particles->box.length[d];
        const double *restrict x = particles->position[d];
        const int n = sorting->cells->count[d];
        for (size_t k = begin; k < end; k++)
            of[k] =
                of[k] * (uint32_t)n + cells_along_fraction(box_fraction(x[k], inverse_length), n);
    }
}

void mf_neighbours_sort(struct neighbours *neighbours, const struct particles *particles) {
    struct sorting sorting = {&neighbours->cells, particles};
    mf_parallel_for(particles->count, particles->threads, find_cells_of, &sorting);
    mf_cells_sort(&neighbours->cells);
}

// Which cells -------------------------------------------------------------------------------------

/// A plane or row of cells nearby, and in which image of the box.
struct nearby {
    int cell, image;
};

/// Those in range of one along axis d: all of them once, if the axis is short.
static int find_nearby(const struct neighbours *neighbours, int d, int cell,
                       struct nearby nearby[WIDEST]) {
    const int n = neighbours->cells.count[d], range = neighbours->range_cells[d];
    int found = 0;
    if (neighbours_span_axis(neighbours, d)) {
        for (int c = 0; c < n; c++)
            nearby[found++] = (struct nearby){c, 0};
        return found;
    }
    for (int c = cell - range; c <= cell + range; c++) {
        const int image = c < 0 ? -1 : c < n ? 0 : 1;
        nearby[found++] = (struct nearby){c - image * n, image};
    }
    return found;
}

/// Cells between two along an axis: the particles in them are at least as far apart.
static int find_gap(int a, int b, int n) {
    const int apart = abs(a - b), nearest = apart < n - apart ? apart : n - apart;
    return nearest > 1 ? nearest - 1 : 0;
}

/// In how many cells along the last axis neighbours may be, given the gaps along the others: −1
/// where there are none.
static int find_depth(const struct neighbours *neighbours, const struct box *box, int gap_x,
                      int gap_y) {
    const double x = gap_x * box->length[0] / neighbours->cells.count[0];
    const double y = gap_y * box->length[1] / neighbours->cells.count[1];
    const double left = neighbours->range * neighbours->range - x * x - y * y;
    if (left < 0)
        return -1;
    const double width = box->length[2] / neighbours->cells.count[2];
    if (neighbours_span_axis(neighbours, 2))
        return neighbours->cells.count[2];
    return (int)fmin(ceil(sqrt(left) / width), neighbours->range_cells[2]);
}

/// Whether the pairs between two planes stand in the list of the one at `plane`.
///
/// With planes enough, those from it up to the range ahead, across the boundary of the box too: so
/// a part of the system reaches only into the next. Else those after it in the order of memory.
static bool owns_pairs(const struct neighbours *neighbours, int plane, int other) {
    const int n = neighbours->cells.count[0], range = neighbours->range_cells[0];
    if (n <= 2 * range)
        return other > plane;
    return other != plane && (other - plane + n) % n <= range;
}

static void add_row(struct pair_search_rows *rows, const struct neighbours *neighbours,
                    const struct box *box, struct nearby x, struct nearby y, int depth) {
    const size_t number = (size_t)x.cell * (size_t)neighbours->cells.count[1] + (size_t)y.cell;
    rows->row[rows->count++] = (struct pair_search_row){
        .start = neighbours->rows.start + number * (neighbours->rows.cells + 1) +
                 neighbours->rows.margin,
        .depth = depth,
        .shift = {(float)(x.image * box->length[0]), (float)(y.image * box->length[1])},
    };
}

/// The rows that are searched for the neighbours of row a, b.
static void find_rows(const struct neighbours *neighbours, const struct box *box, int a, int b,
                      struct pair_search_rows *rows) {
    const int *n = neighbours->cells.count;
    const bool half = neighbours->kind == NEIGHBOURS_HALF;
    struct nearby x[WIDEST], y[WIDEST];
    const int x_count = find_nearby(neighbours, 0, a, x);
    const int y_count = find_nearby(neighbours, 1, b, y);
    rows->first = neighbours->cells.start[((size_t)a * (size_t)n[1] + (size_t)b) * (size_t)n[2]];
    rows->cells = n[2];
    rows->margin = neighbours->rows.margin;
    rows->count = 0;
    add_row(rows, neighbours, box, (struct nearby){a, 0}, (struct nearby){b, 0},
            find_depth(neighbours, box, 0, 0));
    for (int i = 0; i < x_count; i++)
        for (int j = 0; j < y_count; j++) {
            const bool same_plane = x[i].cell == a;
            if (same_plane && y[j].cell == b)
                continue;
            if (half && !(same_plane ? y[j].cell > b : owns_pairs(neighbours, a, x[i].cell)))
                continue;
            const int depth = find_depth(neighbours, box, find_gap(x[i].cell, a, n[0]),
                                         find_gap(y[j].cell, b, n[1]));
            if (depth >= 0)
                add_row(rows, neighbours, box, x[i], y[j], depth);
        }
}

// Search ------------------------------------------------------------------------------------------

/// Append the neighbours of a row of cells.
/// @return the new length of the list, or SIZE_MAX if it is too short
static size_t search_row(struct neighbours *neighbours, const struct particles *particles,
                         const struct pair_search_rows *rows, size_t used, size_t limit) {
    switch (mf_simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return mf_pair_search_avx512(neighbours, particles, rows, used, limit);
    case SIMD_AVX2:
        return mf_pair_search_avx2(neighbours, particles, rows, used, limit);
#endif
    default:
        return mf_pair_search_portable(neighbours, particles, rows, used, limit);
    }
}

/// Build the list of one part; its end becomes SIZE_MAX if the list is too short.
static void build_part(struct neighbours *neighbours, const struct particles *particles,
                       struct neighbours_part *part, size_t limit) {
    struct pair_search_rows rows;
    size_t used = part->begin;
    for (int a = part->first_plane; a < part->last_plane && used != SIZE_MAX; a++)
        for (int b = 0; b < neighbours->cells.count[1] && used != SIZE_MAX; b++) {
            find_rows(neighbours, &particles->box, a, b, &rows);
            used = search_row(neighbours, particles, &rows, used, limit);
        }
    part->end = used;
    if (neighbours->kind == NEIGHBOURS_FULL || used == SIZE_MAX)
        return;
    // One empty row more, for vectors that are longer than a row.
    memset(neighbours->list + used, 0, NEIGHBOURS_ROW * sizeof *neighbours->list);
    neighbours->owner[used / NEIGHBOURS_ROW] = 0;
}

/// Lay out the parts on the list, each with places for its particles.
static void place_parts(struct neighbours *neighbours) {
    const size_t plane = (size_t)neighbours->cells.count[1] * (size_t)neighbours->cells.count[2];
    for (int p = 0; p < neighbours->parts; p++) {
        struct neighbours_part *part = &neighbours->part[p];
        part->first = neighbours->cells.start[(size_t)part->first_plane * plane];
        part->last = neighbours->cells.start[(size_t)part->last_plane * plane];
        part->begin = (size_t)(neighbours->entries_each * (double)part->first) / 16 * 16 +
                      (size_t)p * 16 * PARTICLES_PADDING;
    }
}

/// A list with as many places for each particle as entries_each says. Its contents are lost.
static enum status reserve_list(struct neighbours *neighbours) {
    const size_t capacity = (size_t)(neighbours->entries_each * (double)neighbours->count) +
                            (size_t)(neighbours->parts + 1) * 16 * PARTICLES_PADDING;
    if (capacity <= neighbours->list_capacity)
        return STATUS_OK;
    mf_memory_free(neighbours->list);
    mf_memory_free(neighbours->owner);
    neighbours->list = neighbours->owner = NULL;
    neighbours->list_capacity = 0;
    // Much of the room is never touched, and so takes no memory.
    neighbours->list = mf_memory_uncleared(capacity, sizeof *neighbours->list);
    neighbours->owner = mf_memory_uncleared(capacity / NEIGHBOURS_ROW + PARTICLES_PADDING,
                                            sizeof *neighbours->owner);
    if (neighbours->list == NULL || neighbours->owner == NULL)
        return STATUS_NO_MEMORY;
    neighbours->list_capacity = capacity;
    return STATUS_OK;
}

struct building {
    struct neighbours *neighbours;
    const struct particles *particles;
};

static void build_one(void *context, int p) {
    const struct building *of = context;
    struct neighbours *neighbours = of->neighbours;
    const bool last = p + 1 == neighbours->parts;
    build_part(neighbours, of->particles, &neighbours->part[p],
               last ? neighbours->list_capacity : neighbours->part[p + 1].begin);
}

/// Try to build all parts; *complete tells whether the list had room.
static enum status build_parts(struct neighbours *neighbours, const struct particles *particles,
                               bool *complete) {
    struct building of = {neighbours, particles};
    TRY(reserve_list(neighbours));
    place_parts(neighbours);
    mf_parallel_parts(neighbours->parts, particles->threads, build_one, &of);
    *complete = true;
    for (int p = 0; p < neighbours->parts; p++)
        *complete &= neighbours->part[p].end != SIZE_MAX;
    return STATUS_OK;
}

enum status mf_neighbours_build(struct neighbours *neighbours, const struct particles *particles) {
    bool complete;
    if (neighbours->range == 0)
        return STATUS_OK;
    neighbours_fill_rows(neighbours, particles);
    TRY(build_parts(neighbours, particles, &complete));
    while (!complete) {
        neighbours->entries_each *= 1.5;
        TRY(build_parts(neighbours, particles, &complete));
    }
    return STATUS_OK;
}
