// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hard_start.h"

#include <math.h>
#include <stdbool.h>

/// Distances after a move, in sums of radii: a little more than contact, so that sweeps end.
static const double moved_to = 1 + 1e-3;

/// A fluid needs dozens of sweeps, one near jamming hundreds; what has not parted then has no room.
enum { MOST_SWEEPS = 5000 };

/// What an overlap may be, in sums of radii: the rounding of coordinates that were written down.
static const double tolerance = 1e-9;

/// The particles in cells at least as wide as the largest diameter.
struct grid {
    double *const *position;
    const double *radius;
    const struct box *box;
    size_t count;
    int walls, cells[3];
    double largest; ///< radius
    int32_t *first, *next;
};

static bool is_walled(const struct grid *grid, int d) {
    return grid->walls >> d & 1;
}

static enum status grid_init(struct grid *grid, const struct particles *particles,
                             const double *radius, int walls) {
    enum status status = STATUS_OK;
    *grid = (struct grid){.position = particles->position,
                          .radius = radius,
                          .box = &particles->box,
                          .count = particles->count,
                          .walls = walls};
    for (size_t k = 0; k < grid->count; k++)
        grid->largest = fmax(grid->largest, radius[k]);
    const double room = mf_box_volume(grid->box) / (double)grid->count;
    const double width = fmax(2 * moved_to * grid->largest, pow(room, 1.0 / grid->box->dimensions));
    size_t total = 1;
    for (int d = 0; d < 3; d++) {
        grid->cells[d] = d < grid->box->dimensions
                             ? (int)fmin(1e6, fmax(1, floor(grid->box->length[d] / width)))
                             : 1;
        total *= (size_t)grid->cells[d];
    }
    NEW_ARRAY(grid->first, total);
    NEW_ARRAY(grid->next, grid->count);
done:
    return status;
}

static void grid_clear(struct grid *grid) {
    mf_memory_free(grid->first);
    mf_memory_free(grid->next);
}

static void cell_of(const struct grid *grid, size_t k, int cell[3]) {
    for (int d = 0; d < 3; d++) {
        const double share =
            d < grid->box->dimensions ? grid->position[d][k] / grid->box->length[d] : 0;
        cell[d] = (int)fmin(grid->cells[d] - 1, fmax(0, floor(share * grid->cells[d])));
    }
}

static size_t index_of(const struct grid *grid, const int cell[3]) {
    return ((size_t)cell[0] * (size_t)grid->cells[1] + (size_t)cell[1]) * (size_t)grid->cells[2] +
           (size_t)cell[2];
}

static void fill(struct grid *grid) {
    int cell[3];
    memset(grid->first, 0xff,
           (size_t)grid->cells[0] * (size_t)grid->cells[1] * (size_t)grid->cells[2] *
               sizeof *grid->first);
    for (size_t k = 0; k < grid->count; k++) {
        cell_of(grid, k, cell);
        int32_t *first = &grid->first[index_of(grid, cell)];
        grid->next[k] = *first;
        *first = (int32_t)k;
    }
}

/// From particle i to the nearest image of j; returns the distance.
static double separation(const struct grid *grid, size_t i, size_t j, double r[3]) {
    double square = 0;
    for (int d = 0; d < grid->box->dimensions; d++) {
        r[d] = grid->position[d][j] - grid->position[d][i];
        if (!is_walled(grid, d))
            r[d] = box_nearest(r[d], grid->box->length[d]);
        square += r[d] * r[d];
    }
    return sqrt(square);
}

/// Move both by half of what they lack; along x if they stand at one place.
static void part(const struct grid *grid, size_t i, size_t j, const double r[3], double distance,
                 double contact) {
    const double half = 0.5 * (moved_to * contact - distance);
    for (int d = 0; d < grid->box->dimensions; d++) {
        const double along = distance > 0 ? r[d] / distance : d == 0;
        grid->position[d][i] -= half * along;
        grid->position[d][j] += half * along;
    }
}

/// Look at all pairs of neighbouring cells, and part those that overlap if they are to be.
/// @param[out] pair  one that overlapped
/// @return whether one did
static bool sweep(const struct grid *grid, bool parts, size_t pair[2]) {
    bool found = false;
    int cell[3], other[3];
    for (size_t i = 0; i < grid->count; i++) {
        cell_of(grid, i, cell);
        for (int n = 0; n < 27; n++) {
            const int step[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
            if (grid->box->dimensions == 2 && step[2] != 0)
                continue;
            for (int d = 0; d < 3; d++)
                other[d] = (cell[d] + step[d] + grid->cells[d]) % grid->cells[d];
            for (int32_t k = grid->first[index_of(grid, other)]; k >= 0; k = grid->next[k]) {
                const size_t j = (size_t)k;
                if (j <= i)
                    continue;
                double r[3];
                const double distance = separation(grid, i, j, r);
                const double contact = grid->radius[i] + grid->radius[j];
                if (distance >= contact * (1 - tolerance))
                    continue;
                found = true;
                pair[0] = i;
                pair[1] = j;
                if (!parts)
                    return true;
                part(grid, i, j, r, distance, contact);
            }
        }
    }
    return found;
}

/// Into the box: between the walls, or by the period.
static void confine(const struct grid *grid) {
    for (int d = 0; d < grid->box->dimensions; d++)
        for (size_t k = 0; k < grid->count; k++) {
            const double length = grid->box->length[d], radius = grid->radius[k];
            double *x = &grid->position[d][k];
            if (is_walled(grid, d))
                *x = fmin(length - radius, fmax(radius, *x));
            else
                *x -= length * floor(*x / length);
        }
}

static enum status check_box(const struct grid *grid) {
    for (int d = 0; d < grid->box->dimensions; d++) {
        const double length = grid->box->length[d];
        if (length < (is_walled(grid, d) ? 2 : 4) * grid->largest)
            return mf_status_fail(
                STATUS_BAD_INPUT, "box: its edge %g is below %s of the largest particle, %g",
                length, is_walled(grid, d) ? "the diameter" : "two diameters", 2 * grid->largest);
    }
    return STATUS_OK;
}

enum status mf_hard_start_part(struct particles *particles, const double *radius, int walls) {
    struct grid grid;
    size_t pair[2];
    enum status status = STATUS_OK;
    CHECK(grid_init(&grid, particles, radius, walls));
    CHECK(check_box(&grid));
    for (int n = 0; n < MOST_SWEEPS; n++) {
        confine(&grid);
        fill(&grid);
        if (!sweep(&grid, true, pair))
            break;
    }
    confine(&grid);
done:
    grid_clear(&grid);
    return status;
}

static enum status check_walls(const struct grid *grid, const uint32_t *id) {
    for (int d = 0; d < grid->box->dimensions; d++)
        for (size_t k = 0; k < grid->count && is_walled(grid, d); k++) {
            const double x = grid->position[d][k], radius = grid->radius[k];
            const double near = fmin(x, grid->box->length[d] - x);
            if (near < radius * (1 - tolerance))
                return mf_status_fail(
                    STATUS_BAD_INPUT,
                    "particle %u overlaps a wall of the axis %c at the start: its "
                    "centre is %.10g from it, its radius %g",
                    id[k], "xyz"[d], near, radius);
        }
    return STATUS_OK;
}

enum status mf_hard_start_check(const struct particles *particles, const double *radius,
                                int walls) {
    struct grid grid;
    size_t pair[2];
    double r[3];
    enum status status = STATUS_OK;
    CHECK(grid_init(&grid, particles, radius, walls));
    CHECK(check_box(&grid));
    CHECK(check_walls(&grid, particles->id));
    fill(&grid);
    if (!sweep(&grid, false, pair))
        goto done;
    const uint32_t a = particles->id[pair[0]], b = particles->id[pair[1]];
    status = mf_status_fail(STATUS_BAD_INPUT,
                            "particles %u and %u overlap at the start: they are %.10g apart, their "
                            "radii %g and %g",
                            a < b ? a : b, a < b ? b : a, separation(&grid, pair[0], pair[1], r),
                            radius[pair[a < b ? 0 : 1]], radius[pair[a < b ? 1 : 0]]);
done:
    grid_clear(&grid);
    return status;
}
