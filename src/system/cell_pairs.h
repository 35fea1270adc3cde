// SPDX-License-Identifier: GPL-3.0-or-later
/// @file All pairs nearer than a range in a periodic box of any shape, each once, by cells half a
/// range high or more. Distances are in double precision, whatever the order of the beads.
/// A step of a simulation, which needs its pairs again and again, keeps a list
/// (system/neighbours.h).
#pragma once

#include "base/status.h"
#include "system/box_vectors.h"
#include "system/cells.h"

/// Memory is used again; all zero is none.
struct cell_pairs {
    struct cells cells;
    int reach[3];      ///< of a range, in cells
    int32_t *place[3]; ///< shape [room]: of the beads in the order of cells
    size_t room;
    double edge[3][3]; ///< of differences of places [length]
};

void mf_cell_pairs_clear(struct cell_pairs *pairs);

/// Sort `count` beads for pairs nearer than a range, at most half the least height of the box.
/// @param[in] place  shape [3][count], as system/box_vectors.h has them
/// Fails: NO_MEMORY.
enum status mf_cell_pairs_sort(struct cell_pairs *pairs, const struct box_vectors *box,
                               int32_t *const place[3], size_t count, double range) MUST_USE;

/// A bead and others, each by its number in cells.order.
struct cell_pairs_batch {
    size_t i;                ///< with
    size_t begin, count;     ///< numbers begin … begin + count − 1
    const int32_t *place[3]; ///< shape [count]: of these
    int32_t own[3];
    double edge[3][3];
};
enum { CELL_PAIRS_BATCH = 512 };

/// The way from the bead to one of them [length].
static inline __attribute__((always_inline)) void
cell_pairs_vector(const struct cell_pairs_batch *batch, size_t k, double way[3]) {
    const double a = box_fraction_difference(batch->place[0][k], batch->own[0]);
    const double b = box_fraction_difference(batch->place[1][k], batch->own[1]);
    const double c = box_fraction_difference(batch->place[2][k], batch->own[2]);
    way[0] = a * batch->edge[0][0] + b * batch->edge[1][0] + c * batch->edge[2][0];
    way[1] = b * batch->edge[1][1] + c * batch->edge[2][1];
    way[2] = c * batch->edge[2][2];
}

/// The squared distance to one of them [length²]: for loops with vectors.
static inline __attribute__((always_inline)) double
cell_pairs_square(const struct cell_pairs_batch *batch, size_t k) {
    double way[3];
    cell_pairs_vector(batch, k, way);
    return way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
}

/// All of them. @param[out] squares  shape [count], at most CELL_PAIRS_BATCH
void mf_cell_pairs_squares(const struct cell_pairs_batch *batch, double *restrict squares);

/// Visit pairs, among them all those in range: others are for the visitor to leave out. Tested:
/// test_frame_pairs, against all images.
void mf_cell_pairs_visit(const struct cell_pairs *pairs,
                         void (*take)(void *context, const struct cell_pairs_batch *batch),
                         void *context);

/// A bead with one other.
struct cell_pairs_batch mf_cell_pairs_one(const struct cell_pairs *pairs, int32_t *const place[3],
                                          size_t i, size_t j);
