// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/cell_pairs.h"

#include "base/memory.h"
#include "base/simd.h"

#include <string.h>

void mf_cell_pairs_clear(struct cell_pairs *pairs) {
    mf_cells_clear(&pairs->cells);
    for (int i = 0; i < 3; i++)
        mf_memory_free(pairs->place[i]);
    *pairs = (struct cell_pairs){0};
}

/// Two beads nearer than the range differ by less than range/height of a vector of the box, so that
/// their cells along it are at most ⌈cells range/height⌉ apart: two, or three by rounding. Where
/// the range is near half the box, the search becomes that of all pairs; where it is so short that
/// there are no more cells, those as high as the range are fewer to look at.
static void choose_cells(struct cell_pairs *pairs, size_t count, double range,
                         const struct box_vectors *box, int cells[3]) {
    const double max = fmax(1, floor(cbrt((double)count)));
    for (int i = 0; i < 3; i++) {
        const double share = range / box->height[i];
        const int two = cells_fit(2, share, max), one = cells_fit(1, share, max);
        cells[i] = 3 * two < 5 * one ? one : two;
        pairs->reach[i] = (int)fmin(CELLS_MAX_REACH, ceil(cells[i] * share));
    }
}

static void find_cells(struct cells *cells, int32_t *const place[3]) {
    for (size_t k = 0; k < cells->particles; k++) {
        uint32_t cell = 0;
        for (int i = 0; i < 3; i++)
            cell = cell * (uint32_t)cells->count[i] +
                   cells_along_fraction(place[i][k], cells->count[i]);
        cells->of[k] = cell;
    }
}

static enum status reserve(struct cell_pairs *pairs, size_t count) {
    for (int i = 0; i < 3 && count > pairs->room; i++) {
        mf_memory_free(pairs->place[i]);
        pairs->place[i] = NULL;
        TRY_ARRAY(pairs->place[i], count);
    }
    pairs->room = count > pairs->room ? count : pairs->room;
    return STATUS_OK;
}

enum status mf_cell_pairs_sort(struct cell_pairs *pairs, const struct box_vectors *box,
                               int32_t *const place[3], size_t count, double range) {
    int cells[3];
    TRY(reserve(pairs, count));
    choose_cells(pairs, count, range, box, cells);
    TRY(mf_cells_shape(&pairs->cells, cells, count));
    find_cells(&pairs->cells, place);
    mf_cells_sort(&pairs->cells);
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < count; k++)
            pairs->place[i][k] = place[i][pairs->cells.order[k]];
    for (int n = 0; n < 9; n++)
        pairs->edge[n / 3][n % 3] = 0x1p-32 * box->edge[n / 3][n % 3];
    return STATUS_OK;
}

SIMD_CLONES void mf_cell_pairs_squares(const struct cell_pairs_batch *batch,
                                       double *restrict squares) {
    const struct cell_pairs_batch b = *batch;
    for (size_t k = 0; k < b.count; k++)
        squares[k] = cell_pairs_square(&b, k);
}

/// Look from bead i at those from `begin` on.
static void aim(struct cell_pairs_batch *batch, int32_t *const place[3], size_t i, size_t begin,
                size_t count) {
    batch->i = i;
    batch->begin = begin;
    batch->count = count;
    for (int d = 0; d < 3; d++) {
        batch->own[d] = place[d][i];
        batch->place[d] = place[d] + begin;
    }
}

struct visit {
    const struct cell_pairs *pairs;
    struct cell_pairs_batch batch;
    void (*take)(void *context, const struct cell_pairs_batch *batch);
    void *context;
};

static void take_row(void *context, size_t i, struct cells_row row) {
    struct visit *const visit = context;
    for (size_t begin = row.begin; begin < row.end; begin += CELL_PAIRS_BATCH) {
        const size_t left = row.end - begin;
        const size_t count = left < CELL_PAIRS_BATCH ? left : CELL_PAIRS_BATCH;
        aim(&visit->batch, visit->pairs->place, i, begin, count);
        visit->take(visit->context, &visit->batch);
    }
}

void mf_cell_pairs_visit(const struct cell_pairs *pairs,
                         void (*take)(void *context, const struct cell_pairs_batch *batch),
                         void *context) {
    struct visit visit = {.pairs = pairs, .take = take, .context = context};
    const struct cells_visitor visitor = {take_row, &visit};
    memcpy(visit.batch.edge, pairs->edge, sizeof pairs->edge);
    mf_cells_visit_pairs(&pairs->cells, pairs->reach, &visitor);
}

struct cell_pairs_batch mf_cell_pairs_one(const struct cell_pairs *pairs, int32_t *const place[3],
                                          size_t i, size_t j) {
    struct cell_pairs_batch batch;
    memcpy(batch.edge, pairs->edge, sizeof pairs->edge);
    aim(&batch, place, i, j, 1);
    return batch;
}
