// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frame_grid.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/// Cells within the reach of one, in each direction: a range is two cells, or three by rounding.
enum { REACH = 3, WIDEST = 2 * REACH + 1, MOST_ROWS = 2 * WIDEST * WIDEST + 2 };

void mf_frame_grid_clear(struct frame_grid *grid) {
    mf_memory_free(grid->start);
    mf_memory_free(grid->cell);
    mf_memory_free(grid->bead);
    for (int i = 0; i < 3; i++)
        mf_memory_free(grid->place[i]);
    *grid = (struct frame_grid){0};
}

static enum status reserve_beads(struct frame_grid *grid, size_t beads) {
    enum status status = STATUS_OK;
    if (grid->beads == beads)
        return STATUS_OK;
    mf_frame_grid_clear(grid);
    NEW_ARRAY(grid->cell, beads);
    NEW_ARRAY(grid->bead, beads);
    for (int i = 0; i < 3; i++)
        NEW_ARRAY(grid->place[i], beads);
    grid->beads = beads;
done:
    return status;
}

static enum status reserve_cells(struct frame_grid *grid, size_t cells) {
    if (cells <= grid->room)
        return STATUS_OK;
    mf_memory_free(grid->start);
    grid->room = 0;
    grid->start = mf_memory_zeroed(cells + 2, sizeof *grid->start);
    if (grid->start == NULL)
        return STATUS_NO_MEMORY;
    grid->room = cells;
    return STATUS_OK;
}

/// Two beads nearer than the range differ by less than range/height of a vector of the box, so that
/// their cells along it are at most ⌈cells range/height⌉ apart.
static void choose_cells(struct frame_grid *grid, double range, const struct frame_box *box) {
    const double most = fmax(1, floor(cbrt((double)grid->beads)));
    for (int i = 0; i < 3; i++) {
        const double share = range / box->height[i];
        const double cells = fmax(1, fmin(most, floor(2 / share)));
        grid->cells[i] = (size_t)cells;
        grid->reach[i] = (size_t)fmin(REACH, ceil(cells * share));
    }
}

static size_t find_cell(const struct frame_grid *grid, int32_t *const place[3], size_t bead) {
    size_t cell = 0;
    for (int i = 0; i < 3; i++)
        cell = cell * grid->cells[i] +
               (size_t)((uint64_t)(uint32_t)place[i][bead] * grid->cells[i] >> 32);
    return cell;
}

/// Sort beads by their cells: counting, in two passes.
static enum status sort(struct frame_grid *grid, int32_t *const place[3]) {
    const size_t beads = grid->beads;
    const size_t cells = grid->cells[0] * grid->cells[1] * grid->cells[2];
    TRY(reserve_cells(grid, cells));
    uint32_t *const next = grid->start + 1;
    memset(grid->start, 0, (cells + 2) * sizeof *grid->start);
    for (size_t k = 0; k < beads; k++) {
        grid->cell[k] = (uint32_t)find_cell(grid, place, k);
        next[grid->cell[k] + 1]++;
    }
    for (size_t c = 0; c < cells; c++)
        next[c + 1] += next[c];
    for (size_t k = 0; k < beads; k++) {
        const uint32_t to = next[grid->cell[k]]++;
        grid->bead[to] = (uint32_t)k;
        for (int i = 0; i < 3; i++)
            grid->place[i][to] = place[i][k];
    }
    return STATUS_OK;
}

/// Which cells of one direction are looked at from cell `at`: all, or those within the reach, each
/// once.
static size_t list_cells(const struct frame_grid *grid, int i, size_t at, size_t list[WIDEST]) {
    const size_t all = grid->cells[i], wide = 2 * grid->reach[i] + 1;
    const size_t count = wide < all ? wide : all;
    for (size_t n = 0; n < count; n++)
        list[n] = wide < all ? (at + all - grid->reach[i] + n) % all : n;
    return count;
}

static void add_row(const struct frame_grid *grid, size_t first_cell, size_t end_cell,
                    struct frame_row *rows, size_t *count) {
    const struct frame_row row = {grid->start[first_cell], grid->start[end_cell]};
    if (row.begin == row.end)
        return;
    if (*count > 0 && rows[*count - 1].end == row.begin)
        rows[*count - 1].end = row.end;
    else
        rows[(*count)++] = row;
}

/// The cells of a column that are looked at from cell `at` of its own: one stretch, or two if it
/// goes round. Cells before `least` are left out.
static void add_column(const struct frame_grid *grid, size_t column, size_t at, size_t least,
                       struct frame_row *rows, size_t *count) {
    const size_t all = grid->cells[2], reach = grid->reach[2], base = column * all;
    size_t stretch[2][2] = {{0, all}, {0, 0}};
    if (2 * reach + 1 < all) {
        stretch[0][0] = at >= reach ? at - reach : 0;
        stretch[0][1] = at + reach + 1 < all ? at + reach + 1 : all;
        if (at < reach)
            stretch[1][0] = all + at - reach, stretch[1][1] = all;
        if (at + reach + 1 > all)
            stretch[1][0] = 0, stretch[1][1] = at + reach + 1 - all;
    }
    for (int n = 0; n < 2; n++) {
        const size_t begin = stretch[n][0] > least ? stretch[n][0] : least;
        if (begin < stretch[n][1])
            add_row(grid, base + begin, base + stretch[n][1], rows, count);
    }
}

/// Rows of all cells near this one that come after it, so that each pair is seen once.
static size_t list_rows(const struct frame_grid *grid, size_t a, size_t b, size_t c,
                        struct frame_row rows[MOST_ROWS]) {
    size_t first[WIDEST], second[WIDEST], count = 0;
    const size_t own = a * grid->cells[1] + b;
    const size_t firsts = list_cells(grid, 0, a, first);
    const size_t seconds = list_cells(grid, 1, b, second);
    for (size_t m = 0; m < firsts; m++)
        for (size_t n = 0; n < seconds; n++) {
            const size_t column = first[m] * grid->cells[1] + second[n];
            if (column >= own)
                add_column(grid, column, c, column == own ? c + 1 : 0, rows, &count);
        }
    return count;
}

static void visit_cell(const struct frame_grid *grid, size_t a, size_t b, size_t c,
                       const struct frame_visitor *visitor) {
    struct frame_row rows[MOST_ROWS];
    const size_t cell = (a * grid->cells[1] + b) * grid->cells[2] + c;
    const size_t begin = grid->start[cell], end = grid->start[cell + 1];
    if (begin == end)
        return;
    const size_t count = list_rows(grid, a, b, c, rows);
    for (size_t i = begin; i < end; i++) {
        visitor->take(visitor->context, i, (struct frame_row){i + 1, end});
        for (size_t n = 0; n < count; n++)
            visitor->take(visitor->context, i, rows[n]);
    }
}

enum status mf_frame_grid_sort(struct frame_grid *grid, double range, const struct frame_box *box,
                               int32_t *const place[3], size_t beads) {
    TRY(reserve_beads(grid, beads));
    choose_cells(grid, range, box);
    return sort(grid, place);
}

void mf_frame_grid_visit(const struct frame_grid *grid, const struct frame_visitor *visitor) {
    for (size_t a = 0; a < grid->cells[0]; a++)
        for (size_t b = 0; b < grid->cells[1]; b++)
            for (size_t c = 0; c < grid->cells[2]; c++)
                visit_cell(grid, a, b, c, visitor);
}
