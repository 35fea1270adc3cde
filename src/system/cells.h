// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The cells of a box, and who is in which: sorted, or in chains.
///
/// Sorted particles follow each other in memory, cell by cell, so that a search reads rows
/// of cells; chains are for those that enter and leave one by one. What a step of a simulation
/// waits for sorts here, too, but searches with vectors of its own: system/neighbours.h and
/// forces/soft_discs_cells.h.
#pragma once

#include "base/status.h"
#include "system/box.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/// Memory is used again; all zero is none.
struct cells {
    int count[3]; ///< along each axis, at least 1; the last is the fastest
    size_t total, particles;
    uint32_t *start;       ///< shape [total + 1]: number in `order` of the first of each cell
    uint32_t *of;          ///< shape [particles]: the cell of each, written by the caller
    uint32_t *order;       ///< shape [particles]: by cell, and in each in the order that they had
    size_t start_capacity; ///< cells that `start` has room for
};

/// Make room. Contents are lost. Fails: NO_MEMORY.
enum status mf_cells_shape(struct cells *cells, const int count[3], size_t particles) MUST_USE;
void mf_cells_clear(struct cells *cells);

/// Fill `start` and `order` from `of`, by counting.
void mf_cells_sort(struct cells *cells);

// Geometry ----------------------------------------------------------------------------------------

/// Cells at least as wide as `width` that fit into a length, at most so many.
static inline int cells_fit(double length, double width, double max) {
    return (int)fmax(1, fmin(max, floor(length / width)));
}

/// The same along all axes of a box; 1 along those that it has not.
void mf_cells_fit_box(const struct box *box, double width, double max, int count[3]);

/// Of `count` cells along an axis the one at a share of its length; outside, the first or the last.
static inline int cells_along(double share, int count) {
    return (int)fmin(count - 1, fmax(0, floor(share * count)));
}

/// The same of a fraction (box_fraction).
static inline uint32_t cells_along_fraction(int32_t fraction, int count) {
    return (uint32_t)((uint64_t)(uint32_t)fraction * (uint32_t)count >> 32);
}

static inline size_t cells_total(const int count[3]) {
    return (size_t)count[0] * (size_t)count[1] * (size_t)count[2];
}

static inline size_t cells_number(const int count[3], const int cell[3]) {
    return ((size_t)cell[0] * (size_t)count[1] + (size_t)cell[1]) * (size_t)count[2] +
           (size_t)cell[2];
}

enum { CELLS_AROUND = 27 };

/// Numbers of a cell and all that touch it in a periodic box, some twice if it is short.
/// @return how many: 9 or 27
int mf_cells_around(const int count[3], const int cell[3], int dimensions,
                    size_t around[CELLS_AROUND]);

// Sorted ------------------------------------------------------------------------------------------

/// Numbers begin … end − 1 in `order`.
struct cells_row {
    size_t begin, end;
};

/// Who takes pairs: number `i` of `order` with each of a row.
struct cells_visitor {
    void (*take)(void *context, size_t i, struct cells_row row);
    void *context;
};

/// The most that a search may reach.
enum { CELLS_MAX_REACH = 3 };

/// Visit all pairs in cells at most `reach` from each other in a periodic box, each once. Where the
/// cells in reach are all that there are, rows become all particles. Tested: test_frame_pairs.
void mf_cells_visit_pairs(const struct cells *cells, const int reach[3],
                          const struct cells_visitor *visitor);

// Chains ------------------------------------------------------------------------------------------

/// Particle k becomes the first of a cell, `*first`, −1: empty. @param[in,out] next  shape
/// [particles]: behind each in its cell, −1: none
static inline void cells_enter(int32_t *first, int32_t *next, int32_t k) {
    next[k] = *first;
    *first = k;
}
