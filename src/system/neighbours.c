// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/neighbours.h"

#include "base/memory.h"
#include "base/simd.h"
#include "close.h"

#include <stdlib.h>

/// Cells are at least as wide as the range, or as half of it: neighbours lie within `reach` cells.
enum { LARGEST_REACH = 2, WIDEST = 2 * LARGEST_REACH + 1 };

/// Cells are halved along one axis after the other, the fastest first, as long as this many
/// particles remain in one: fewer candidates are looked at, but fewer particles share the work of
/// collecting them. Measured for reach 1 1 1, 1 1 2 and 2 2 2: 1240, 950 and 690 µs for 2744
/// particles with 45 in a cell of the range; 690, 600 and 910 µs for 4000 with 18; 280, 320 and
/// 930 µs for 3000 with 7. A reach of 3 along the last axis gains nothing.
static const double fewest_in_cell = 5;

/// Cells for each particle, at most: more would only be empty.
static const double most_cells = 4;

static void shape_cells(struct neighbours *neighbours, const struct box *box) {
    const double room = box_volume(box) / (double)neighbours->count; // of a particle
    const double narrowest = pow(room / most_cells, 1.0 / box->dimensions);
    double in_cell = pow(neighbours->range, box->dimensions) / room;
    neighbours->cell_total = 1;
    for (int d = 2; d >= 0; d--) {
        neighbours->reach[d] = neighbours->cells[d] = 1;
        if (d >= box->dimensions)
            continue;
        if (in_cell / 2 >= fewest_in_cell) {
            in_cell /= 2;
            neighbours->reach[d] = LARGEST_REACH;
        }
        const double width = fmax(neighbours->range / neighbours->reach[d], narrowest);
        neighbours->cells[d] = (int)fmax(1, floor(box->length[d] / width));
        neighbours->cell_total *= (size_t)neighbours->cells[d];
    }
}

enum status neighbours_init(struct neighbours *neighbours, enum neighbours_kind kind,
                            const struct box *box, size_t count, double cutoff, double skin) {
    enum status status = STATUS_OK;
    *neighbours = (struct neighbours){
        .kind = kind, .range = cutoff + skin, .skin = skin, .count = count, .cell_total = 1};
    if (box_shortest(box) < 2 * cutoff)
        return status_fail(STATUS_BAD_INPUT,
                           "the box is too small: its shortest edge %g is below twice the cutoff "
                           "%g, so the nearest image is not the only one in range",
                           box_shortest(box), cutoff);
    // A particle may meet only the nearest image of another, also in the skin.
    if (neighbours->range > box_shortest(box) / 2) {
        neighbours->range = box_shortest(box) / 2;
        neighbours->skin = neighbours->range - cutoff;
    }
    shape_cells(neighbours, box);
    NEW_ARRAY(neighbours->start, count + 1);
    NEW_ARRAY(neighbours->cell_start, neighbours->cell_total + 1);
    NEW_ARRAY(neighbours->cell_of, count);
    NEW_ARRAY(neighbours->order, count);
    NEW_ARRAY(neighbours->around_index, count + PARTICLES_PADDING);
    NEW_ARRAY(neighbours->around_mask, count + PARTICLES_PADDING);
    for (int d = 0; d < box->dimensions; d++) {
        NEW_ARRAY(neighbours->built[d], count);
        NEW_ARRAY(neighbours->around[d], count + PARTICLES_PADDING);
    }
done:
    if (status != STATUS_OK)
        neighbours_clear(neighbours);
    return status;
}

void neighbours_clear(struct neighbours *neighbours) {
    memory_free(neighbours->start);
    memory_free(neighbours->list);
    memory_free(neighbours->owner);
    memory_free(neighbours->cell_start);
    memory_free(neighbours->cell_of);
    memory_free(neighbours->order);
    memory_free(neighbours->around_index);
    memory_free(neighbours->around_mask);
    for (int d = 0; d < 3; d++) {
        memory_free(neighbours->built[d]);
        memory_free(neighbours->around[d]);
    }
    *neighbours = (struct neighbours){0};
}

/// Counting sort by cell: fills cell_of, cell_start and order. Stable, so sorted stays sorted.
static void sort_by_cell(struct neighbours *neighbours, const struct particles *particles) {
    uint32_t *start = neighbours->cell_start;
    memset(start, 0, (neighbours->cell_total + 1) * sizeof *start);
    for (size_t k = 0; k < particles->count; k++) {
        uint32_t cell = 0;
        for (int d = 0; d < particles->box.dimensions; d++) {
            const uint64_t fraction = (uint32_t)particles->fraction[d][k];
            const uint32_t n = (uint32_t)neighbours->cells[d];
            cell = cell * n + (uint32_t)(fraction * n >> 32);
        }
        neighbours->cell_of[k] = cell;
        start[cell + 1]++;
    }
    for (size_t c = 0; c < neighbours->cell_total; c++)
        start[c + 1] += start[c];
    for (size_t k = 0; k < particles->count; k++)
        neighbours->order[start[neighbours->cell_of[k]]++] = (uint32_t)k;
    memmove(start + 1, start, neighbours->cell_total * sizeof *start);
    start[0] = 0;
}

/// Consecutive cells along an axis.
struct stretch {
    int begin, end;
};

/// The cells within `reach` of one, in ascending order: two stretches if they wrap.
static int find_stretches(int cell, int reach, int n, struct stretch stretch[2]) {
    const int begin = cell - reach, end = cell + reach + 1;
    if (end - begin >= n) {
        stretch[0] = (struct stretch){0, n};
        return 1;
    }
    if (begin >= 0 && end <= n) {
        stretch[0] = (struct stretch){begin, end};
        return 1;
    }
    stretch[0] = (struct stretch){0, end > n ? end - n : end};
    stretch[1] = (struct stretch){begin < 0 ? begin + n : begin, n};
    return 2;
}

/// The same cell by cell.
static int find_cells(int cell, int reach, int n, int around[WIDEST]) {
    struct stretch stretch[2];
    const int count = find_stretches(cell, reach, n, stretch);
    int found = 0;
    for (int s = 0; s < count; s++)
        for (int c = stretch[s].begin; c < stretch[s].end; c++)
            around[found++] = c;
    return found;
}

/// Cells between two along an axis: the particles in them are at least as far apart.
static int find_gap(int a, int b, int n) {
    const int apart = abs(a - b), nearest = apart < n - apart ? apart : n - apart;
    return nearest > 1 ? nearest - 1 : 0;
}

/// How far neighbours reach along the last axis, by the gaps along the others: −1 where there are
/// none.
struct depths {
    int reach[LARGEST_REACH][LARGEST_REACH];
};

static struct depths find_depths(const struct neighbours *neighbours, const struct box *box) {
    struct depths depths;
    double width[3];
    for (int d = 0; d < 3; d++)
        width[d] = box->length[d] / neighbours->cells[d];
    for (int a = 0; a < LARGEST_REACH; a++)
        for (int b = 0; b < LARGEST_REACH; b++) {
            const double x = a * width[0], y = b * width[1];
            const double left = neighbours->range * neighbours->range - x * x - y * y;
            const double reach = fmin(ceil(sqrt(left) / width[2]), neighbours->cells[2]);
            depths.reach[a][b] = left < 0 ? -1 : (int)reach;
        }
    return depths;
}

static void add_run(struct close_cell *cell, size_t begin, size_t end) {
    if (begin >= end)
        return;
    if (cell->count > 0 && cell->run[cell->count - 1].end == begin)
        cell->run[cell->count - 1].end = end;
    else
        cell->run[cell->count++] = (struct close_run){begin, end};
}

/// The runs of particles around a cell; a half list wants none before the cell's own.
static void find_runs(const struct neighbours *neighbours, const struct depths *depths,
                      const int at[3], struct close_cell *cell) {
    const int *n = neighbours->cells, *reach = neighbours->reach;
    const size_t first = neighbours->kind == NEIGHBOURS_HALF ? cell->begin : 0;
    int x[WIDEST], y[WIDEST];
    const int x_count = find_cells(at[0], reach[0], n[0], x);
    const int y_count = find_cells(at[1], reach[1], n[1], y);
    cell->count = 0;
    for (int a = 0; a < x_count; a++)
        for (int b = 0; b < y_count; b++) {
            struct stretch z[2];
            const int depth =
                depths->reach[find_gap(x[a], at[0], n[0])][find_gap(y[b], at[1], n[1])];
            const int z_count = depth < 0 ? 0 : find_stretches(at[2], depth, n[2], z);
            const uint32_t *start = neighbours->cell_start +
                                    ((size_t)x[a] * (size_t)n[1] + (size_t)y[b]) * (size_t)n[2];
            for (int c = 0; c < z_count; c++) {
                const size_t begin = start[z[c].begin], end = start[z[c].end];
                add_run(cell, begin > first ? begin : first, end);
            }
        }
}

/// Make room for `more` entries beyond `used`, keeping what is there.
static enum status grow_list(struct neighbours *neighbours, size_t used, size_t more) {
    enum status status = STATUS_OK;
    if (used + more <= neighbours->list_capacity)
        return STATUS_OK;
    const size_t capacity = (used + more) * 3 / 2;
    int32_t *list = NULL, *owner = NULL;
    NEW_ARRAY(list, capacity);
    NEW_ARRAY(owner, capacity / NEIGHBOURS_ROW + 1);
    if (used > 0) {
        memcpy(list, neighbours->list, used * sizeof *list);
        memcpy(owner, neighbours->owner, (used / NEIGHBOURS_ROW + 1) * sizeof *owner);
    }
    memory_free(neighbours->list);
    memory_free(neighbours->owner);
    neighbours->list = list;
    neighbours->owner = owner;
    neighbours->list_capacity = capacity;
    return STATUS_OK;
done:
    memory_free(list);
    memory_free(owner);
    return status;
}

static size_t search(struct neighbours *neighbours, const struct particles *particles,
                     const struct close_cell *cell, size_t used) {
    switch (simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return close_avx512(neighbours, particles, cell, used);
    case SIMD_AVX2:
        return close_avx2(neighbours, particles, cell, used);
#endif
    default:
        return close_portable(neighbours, particles, cell, used);
    }
}

/// Append the neighbours of the particles of a cell, a few at a time: room is made for all that
/// may be found, and where thousands crowd in one cell that is far more than there will be.
static enum status append_cell(struct neighbours *neighbours, const struct particles *particles,
                               struct close_cell cell, size_t *used) {
    enum { AT_A_TIME = 32 };
    const size_t last = cell.end;
    size_t most = NEIGHBOURS_ROW;
    for (int r = 0; r < cell.count; r++)
        most += cell.run[r].end - cell.run[r].begin;
    for (; cell.begin < last; cell.begin = cell.end) {
        cell.end = last - cell.begin < AT_A_TIME ? last : cell.begin + AT_A_TIME;
        TRY(grow_list(neighbours, *used, most * (cell.end - cell.begin) + PARTICLES_PADDING));
        *used = search(neighbours, particles, &cell, *used);
    }
    return STATUS_OK;
}

/// One empty row more, for vectors that are longer than a row.
static enum status append_empty_row(struct neighbours *neighbours, size_t used) {
    TRY(grow_list(neighbours, used, PARTICLES_PADDING));
    memset(neighbours->list + used, 0, NEIGHBOURS_ROW * sizeof *neighbours->list);
    neighbours->owner[used / NEIGHBOURS_ROW] = 0;
    return STATUS_OK;
}

static enum status build_list(struct neighbours *neighbours, const struct particles *particles) {
    const int *n = neighbours->cells;
    const struct depths depths = find_depths(neighbours, &particles->box);
    struct close_run run[2 * WIDEST * WIDEST];
    struct close_cell cell = {.run = run};
    const uint32_t *start = neighbours->cell_start;
    size_t used = 0;
    for (int a = 0; a < n[0]; a++)
        for (int b = 0; b < n[1]; b++)
            for (int c = 0; c < n[2]; c++, start++) {
                cell.begin = start[0];
                cell.end = start[1];
                if (cell.begin == cell.end)
                    continue;
                find_runs(neighbours, &depths, (const int[3]){a, b, c}, &cell);
                TRY(append_cell(neighbours, particles, cell, &used));
            }
    neighbours->start[neighbours->count] = used;
    return neighbours->kind == NEIGHBOURS_HALF ? append_empty_row(neighbours, used) : STATUS_OK;
}

enum status neighbours_sort_and_build(struct neighbours *neighbours, struct particles *particles) {
    particles_wrap(particles);
    particles_update_fractions(particles);
    sort_by_cell(neighbours, particles);
    particles_permute(particles, neighbours->order);
    particles_update_fractions(particles);
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(neighbours->built[d], particles->position[d],
               particles->count * sizeof *particles->position[d]);
    return build_list(neighbours, particles);
}

/// Swap the positions with those of the last build.
static void exchange_positions(struct neighbours *neighbours, struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *now = particles->position[d];
        particles->position[d] = neighbours->built[d];
        neighbours->built[d] = now;
    }
    particles_update_fractions(particles);
}

enum status neighbours_rebuild(struct neighbours *neighbours, struct particles *particles) {
    exchange_positions(neighbours, particles);
    sort_by_cell(neighbours, particles);
    const enum status status = build_list(neighbours, particles);
    exchange_positions(neighbours, particles);
    return status;
}

bool neighbours_are_stale(const struct neighbours *neighbours, const struct particles *particles) {
    const int dimensions = particles->box.dimensions;
    double largest = 0;
#pragma omp simd reduction(max : largest)
    for (size_t k = 0; k < particles->count; k++) {
        double square = 0;
        for (int d = 0; d < dimensions; d++) {
            const double moved = particles->position[d][k] - neighbours->built[d][k];
            square += moved * moved;
        }
        largest = square > largest ? square : largest;
    }
    return largest >= 0.25 * neighbours->skin * neighbours->skin;
}

void neighbours_visit_distances(
    const struct neighbours *neighbours, const struct particles *particles, double range,
    void (*visit)(void *context, const float *squared_distances, size_t count), void *context) {
    enum { BATCH = 512 };
    const struct box *box = &particles->box;
    const float limit = (float)(range * range);
    float scale[3], squared[BATCH];
    for (int d = 0; d < 3; d++)
        scale[d] = d < box->dimensions ? (float)(box->length[d] * 0x1p-32) : 0;
    size_t found = 0;
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->start[i + 1]; k++) {
            const size_t j = (size_t)neighbours->list[k];
            float square = 0;
            for (int d = 0; d < 3; d++) {
                const float dx =
                    scale[d] * (float)box_fraction_difference(particles->fraction[d][i],
                                                              particles->fraction[d][j]);
                square += dx * dx;
            }
            squared[found] = square;
            found += square < limit && j != i;
            if (found == BATCH) {
                visit(context, squared, found);
                found = 0;
            }
        }
    visit(context, squared, found);
}
