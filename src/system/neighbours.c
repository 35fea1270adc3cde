// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/neighbours.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "neighbours_build.h"

/// Cells are halved along one axis after the other, the fastest first, as long as this many
/// particles remain in one: fewer candidates are looked at, but fewer particles share the work of
/// finding them. Measured for range_cells 1 1 1, 1 1 2 and 2 2 2 on Zen 3: 1240, 950 and 690 µs for
/// 2744 particles with 45 in a cell of the range; 690, 600 and 910 µs for 4000 with 18; 280, 320
/// and 930 µs for 3000 with 7. Along the last axis a halved cell is halved again, which shortens
/// the runs: 3 % more steps/s for Lennard-Jones on Zen 5, while it costs a fluid with 3 in a cell 5
/// %.
static const double fewest_in_cell = 5;

/// Cells for each particle, at most: more would only be empty.
static const double max_cells = 4;

static void shape_cells(struct neighbours *neighbours, const struct box *box, int count[3]) {
    const double capacity = mf_box_volume(box) / (double)neighbours->count; // of a particle
    const double max = neighbours->range > 0 ? max_cells : 1 / fewest_in_cell;
    const double narrowest = pow(capacity / max, 1.0 / box->dimensions);
    double in_cell = pow(neighbours->range, box->dimensions) / capacity;
    for (int d = 2; d >= 0; d--) {
        neighbours->range_cells[d] = count[d] = 1;
        if (d >= box->dimensions)
            continue;
        if (in_cell / 2 >= fewest_in_cell) {
            in_cell /= 2;
            neighbours->range_cells[d] =
                d == 2 ? 2 * NEIGHBOURS_MAX_RANGE_CELLS : NEIGHBOURS_MAX_RANGE_CELLS;
        }
        const double width = fmax(neighbours->range / neighbours->range_cells[d], narrowest);
        count[d] = cells_fit(box->length[d], width, INT32_MAX);
    }
}

/// Divide the planes of cells into parts at least as thick as the range.
static void divide(struct neighbours *neighbours) {
    const int planes = neighbours->cells.count[0];
    int parts = planes / neighbours->range_cells[0] / 2 * 2;
    if (neighbours->kind == NEIGHBOURS_FULL || parts < 4)
        parts = 1;
    neighbours->parts = parts < NEIGHBOURS_MAX_PARTS ? parts : NEIGHBOURS_MAX_PARTS;
    for (int p = 0; p < neighbours->parts; p++)
        neighbours->part[p] =
            (struct neighbours_part){.first_plane = planes * p / neighbours->parts,
                                     .last_plane = planes * (p + 1) / neighbours->parts};
}

/// Places on the list for each particle of a uniform fluid, and a quarter more.
static double expect_entries(const struct neighbours *neighbours, const struct box *box) {
    const double density = (double)neighbours->count / mf_box_volume(box);
    const double around = density * mf_box_shell_volume(box, 0, neighbours->range);
    return 1.25 * (neighbours->kind == NEIGHBOURS_HALF ? around / 2 + NEIGHBOURS_ROW : around) + 16;
}

enum status mf_neighbours_init(struct neighbours *neighbours, enum neighbours_kind kind,
                               const struct box *box, size_t count, double cutoff, double skin) {
    enum status status = STATUS_OK;
    *neighbours = (struct neighbours){
        .kind = kind, .range = cutoff > 0 ? cutoff + skin : 0, .skin = skin, .count = count};
    int cells[3];
    if (mf_box_shortest(box) < 2 * cutoff)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "the box is too small: its shortest edge %g" STATUS_LENGTH " is below twice the cutoff "
            "%g" STATUS_LENGTH
            ", so the nearest image is not the only one in range; a larger box with more "
            "particles, or a shorter cutoff, would do",
            mf_box_shortest(box), cutoff);
    // A particle may meet only the nearest image of another, also in the skin.
    if (neighbours->range > mf_box_shortest(box) / 2) {
        neighbours->range = mf_box_shortest(box) / 2;
        neighbours->skin = neighbours->range - cutoff;
    }
    shape_cells(neighbours, box, cells);
    CHECK(mf_cells_shape(&neighbours->cells, cells, count));
    divide(neighbours);
    neighbours->entries_each = expect_entries(neighbours, box);
    NEW_ARRAY(neighbours->start, count);
    NEW_ARRAY(neighbours->stop, count);
    CHECK(mf_neighbours_init_rows(neighbours, box));
    for (int d = 0; d < box->dimensions; d++)
        NEW_ARRAY(neighbours->built[d], count);
done:
    if (status != STATUS_OK)
        mf_neighbours_clear(neighbours);
    return status;
}

void mf_neighbours_clear(struct neighbours *neighbours) {
    mf_memory_free(neighbours->start);
    mf_memory_free(neighbours->stop);
    mf_memory_free(neighbours->list);
    mf_memory_free(neighbours->owner);
    mf_cells_clear(&neighbours->cells);
    mf_neighbours_clear_rows(neighbours);
    for (int d = 0; d < 3; d++)
        mf_memory_free(neighbours->built[d]);
    *neighbours = (struct neighbours){0};
}

size_t mf_neighbours_entries(const struct neighbours *neighbours) {
    size_t entries = 0;
    for (int p = 0; p < neighbours->parts; p++)
        entries += neighbours->part[p].end - neighbours->part[p].begin;
    return entries;
}

size_t mf_neighbours_listed(const struct neighbours *neighbours) {
    size_t listed = 0;
    for (size_t i = 0; i < neighbours->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++)
            listed += neighbours->list[k] != (int32_t)i;
    return listed;
}

enum status mf_neighbours_sort_and_build(struct neighbours *neighbours,
                                         struct particles *particles) {
    if (!mf_particles_wrap(particles))
        return mf_status_fail(STATUS_UNSTABLE, "a position is nan, or beyond the reach of the box");
    mf_neighbours_sort(neighbours, particles);
    mf_particles_permute(particles, neighbours->cells.order);
    mf_particles_settle(particles, neighbours->built);
    return mf_neighbours_build(neighbours, particles);
}

/// Swap the positions with those of the last build.
static void exchange_positions(struct neighbours *neighbours, struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *now = particles->position[d];
        particles->position[d] = neighbours->built[d];
        neighbours->built[d] = now;
    }
    mf_particles_update_fractions(particles);
}

enum status mf_neighbours_rebuild(struct neighbours *neighbours, struct particles *particles) {
    mf_particles_label_places(particles);
    exchange_positions(neighbours, particles);
    mf_neighbours_sort(neighbours, particles);
    const enum status status = mf_neighbours_build(neighbours, particles);
    exchange_positions(neighbours, particles);
    return status;
}

struct watched {
    const struct neighbours *neighbours;
    const struct particles *particles;
};

/// Whether some particle of a stretch has moved by half the skin: 0 or 1. Vectors want the number
/// of dimensions to be known.
static inline __attribute__((always_inline)) double
count_moved(const struct watched *watched, size_t begin, size_t end, const int dimensions) {
    const double limit = 0.25 * watched->neighbours->skin * watched->neighbours->skin;
    const double *const *position = (const double *const *)watched->particles->position;
    const double *const *built = (const double *const *)watched->neighbours->built;
    int moved = 0;
    for (size_t k = begin; k < end; k++) {
        double square = 0;
        for (int d = 0; d < dimensions; d++)
            square += (position[d][k] - built[d][k]) * (position[d][k] - built[d][k]);
        moved |= !(square < limit);
    }
    return moved;
}

SIMD_CLONES static double has_moved(const void *context, size_t begin, size_t end) {
    const struct watched *watched = context;
    return watched->particles->box.dimensions == 2 ? count_moved(watched, begin, end, 2)
                                                   : count_moved(watched, begin, end, 3);
}

bool mf_neighbours_are_stale(const struct neighbours *neighbours,
                             const struct particles *particles) {
    const struct watched watched = {neighbours, particles};
    if (neighbours->skin <= 0)
        return true;
    return mf_parallel_sum(particles->count, particles->threads, has_moved, &watched) > 0;
}

/// Lengths of the box in units of its fractions, 0 along an axis that is not there.
static void find_scale(const struct box *box, float scale[3]) {
    for (int d = 0; d < 3; d++)
        scale[d] = d < box->dimensions ? (float)(box->length[d] * 0x1p-32) : 0;
}

static inline float square_distance(const struct particles *particles, const float scale[3],
                                    size_t i, size_t j) {
    float square = 0;
    for (int d = 0; d < 3; d++) {
        const float dx = scale[d] * (float)box_fraction_difference(particles->fraction[d][i],
                                                                   particles->fraction[d][j]);
        square += dx * dx;
    }
    return square;
}

void mf_neighbours_visit_distances(
    const struct neighbours *neighbours, const struct particles *particles, double range,
    void (*visit)(void *context, const float *squared_distances, size_t count), void *context) {
    const float limit = (float)(range * range);
    float scale[3], squared[NEIGHBOURS_BATCH];
    size_t found = 0;
    find_scale(&particles->box, scale);
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
            const size_t j = (size_t)neighbours->list[k];
            const float square = square_distance(particles, scale, i, j);
            squared[found] = square;
            found += square < limit && j != i;
            if (found == NEIGHBOURS_BATCH) {
                visit(context, squared, found);
                found = 0;
            }
        }
    visit(context, squared, found);
}

void mf_neighbours_visit_pairs(const struct neighbours *neighbours,
                               const struct particles *particles, double range,
                               void (*visit)(void *context, const struct neighbours_batch *batch),
                               void *context) {
    const float limit = (float)(range * range);
    struct neighbours_batch batch = {0};
    float scale[3];
    find_scale(&particles->box, scale);
    for (size_t i = 0; i < particles->count; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
            const size_t j = (size_t)neighbours->list[k];
            const float square = square_distance(particles, scale, i, j);
            batch.squared[batch.count] = square;
            batch.id_i[batch.count] = particles->id[i];
            batch.id_j[batch.count] = particles->id[j];
            batch.count += square < limit && j != i;
            if (batch.count == NEIGHBOURS_BATCH) {
                visit(context, &batch);
                batch.count = 0;
            }
        }
    visit(context, &batch);
}
