// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/cells.h"

#include "base/memory.h"

#include <string.h>

enum { WIDEST = 2 * CELLS_MAX_REACH + 1, MAX_ROWS = 2 * WIDEST * WIDEST + 2 };

void mf_cells_clear(struct cells *cells) {
    mf_memory_free(cells->start);
    mf_memory_free(cells->of);
    mf_memory_free(cells->order);
    *cells = (struct cells){0};
}

enum status mf_cells_shape(struct cells *cells, const int count[3], size_t particles) {
    enum status status = STATUS_OK;
    const size_t total = cells_total(count);
    if (cells->of == NULL || cells->particles != particles) {
        mf_cells_clear(cells);
        NEW_ARRAY(cells->of, particles);
        NEW_ARRAY(cells->order, particles);
        cells->particles = particles;
    }
    if (cells->start == NULL || cells->start_capacity < total) {
        mf_memory_free(cells->start);
        NEW_ARRAY(cells->start, total + 2); // one more for counting
        cells->start_capacity = total;
    }
    memcpy(cells->count, count, sizeof cells->count);
    cells->total = total;
done:
    if (status != STATUS_OK)
        mf_cells_clear(cells);
    return status;
}

void mf_cells_sort(struct cells *cells) {
    // Counted two further, summed up and counted on again, a cell's end becomes the next's begin.
    uint32_t *const next = cells->start + 1;
    memset(cells->start, 0, (cells->total + 2) * sizeof *cells->start);
    for (size_t k = 0; k < cells->particles; k++)
        next[cells->of[k] + 1]++;
    for (size_t cell = 0; cell < cells->total; cell++)
        next[cell + 1] += next[cell];
    for (size_t k = 0; k < cells->particles; k++)
        cells->order[next[cells->of[k]]++] = (uint32_t)k;
}

// Geometry ----------------------------------------------------------------------------------------

void mf_cells_fit_box(const struct box *box, double width, double max, int count[3]) {
    for (int d = 0; d < 3; d++)
        count[d] = d < box->dimensions ? cells_fit(box->length[d], width, max) : 1;
}

int mf_cells_around(const int count[3], const int cell[3], int dimensions,
                    size_t around[CELLS_AROUND]) {
    int found = 0;
    for (int n = 0; n < CELLS_AROUND; n++) {
        const int step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
        int other[3];
        if (dimensions == 2 && step[2] != 0)
            continue;
        for (int d = 0; d < 3; d++)
            other[d] = (cell[d] + step[d] + count[d]) % count[d];
        around[found++] = cells_number(count, other);
    }
    return found;
}

// Rows of cells that are searched ----------------------------------------------------------------

/// Which cells of an axis are in reach of cell `at`: all, or those so near, each once.
static int list_cells(int all, int reach, int at, int list[WIDEST]) {
    const int wide = 2 * reach + 1, count = wide < all ? wide : all;
    for (int n = 0; n < count; n++)
        list[n] = wide < all ? (at + all - reach + n) % all : n;
    return count;
}

static void add_row(const struct cells *cells, size_t first_cell, size_t end_cell,
                    struct cells_row *rows, size_t *count) {
    const struct cells_row row = {cells->start[first_cell], cells->start[end_cell]};
    if (row.begin == row.end)
        return;
    if (*count > 0 && rows[*count - 1].end == row.begin)
        rows[*count - 1].end = row.end;
    else
        rows[(*count)++] = row;
}

/// The cells of a column in reach of cell `at` of its own: one stretch, or two if it goes round.
/// Cells before `min` are left out.
static void add_column(const struct cells *cells, size_t column, int reach, int at, int min,
                       struct cells_row *rows, size_t *count) {
    const int all = cells->count[2];
    const size_t base = column * (size_t)all;
    int stretch[2][2] = {{0, all}, {0, 0}};
    if (2 * reach + 1 < all) {
        stretch[0][0] = at >= reach ? at - reach : 0;
        stretch[0][1] = at + reach + 1 < all ? at + reach + 1 : all;
        if (at < reach)
            stretch[1][0] = all + at - reach, stretch[1][1] = all;
        if (at + reach + 1 > all)
            stretch[1][0] = 0, stretch[1][1] = at + reach + 1 - all;
    }
    for (int n = 0; n < 2; n++) {
        const int begin = stretch[n][0] > min ? stretch[n][0] : min;
        if (begin < stretch[n][1])
            add_row(cells, base + (size_t)begin, base + (size_t)stretch[n][1], rows, count);
    }
}

/// Rows of all cells near this one that come after it, so that each pair is seen once.
static size_t list_rows(const struct cells *cells, const int reach[3], const int cell[3],
                        struct cells_row rows[MAX_ROWS]) {
    int first[WIDEST], second[WIDEST];
    size_t count = 0;
    const int own = cell[0] * cells->count[1] + cell[1];
    const int firsts = list_cells(cells->count[0], reach[0], cell[0], first);
    const int seconds = list_cells(cells->count[1], reach[1], cell[1], second);
    for (int m = 0; m < firsts; m++)
        for (int n = 0; n < seconds; n++) {
            const int column = first[m] * cells->count[1] + second[n];
            if (column >= own)
                add_column(cells, (size_t)column, reach[2], cell[2],
                           column == own ? cell[2] + 1 : 0, rows, &count);
        }
    return count;
}

static void visit_cell(const struct cells *cells, const int reach[3], const int cell[3],
                       const struct cells_visitor *visitor) {
    struct cells_row rows[MAX_ROWS];
    const size_t number = cells_number(cells->count, cell);
    const size_t begin = cells->start[number], end = cells->start[number + 1];
    if (begin == end)
        return;
    const size_t count = list_rows(cells, reach, cell, rows);
    for (size_t i = begin; i < end; i++) {
        visitor->take(visitor->context, i, (struct cells_row){i + 1, end});
        for (size_t n = 0; n < count; n++)
            visitor->take(visitor->context, i, rows[n]);
    }
}

void mf_cells_visit_pairs(const struct cells *cells, const int reach[3],
                          const struct cells_visitor *visitor) {
    for (int a = 0; a < cells->count[0]; a++)
        for (int b = 0; b < cells->count[1]; b++)
            for (int c = 0; c < cells->count[2]; c++)
                visit_cell(cells, reach, (const int[3]){a, b, c}, visitor);
}
