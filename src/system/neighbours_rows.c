// SPDX-License-Identifier: GPL-3.0-or-later
#include "neighbours_rows.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"

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

void mf_neighbours_fill_rows(struct neighbours *neighbours, const struct particles *particles) {
    struct filling filling = {neighbours, particles};
    place_rows(neighbours);
    mf_parallel_for(row_count(neighbours), particles->threads, fill_rows, &filling);
}
