// SPDX-License-Identifier: GPL-3.0-or-later
/// @file From particles to a list: sorting by cell, and the search part by part.
#pragma once

#include "system/neighbours.h"

/// Cells are at least as wide as the range, or as half of it: neighbours lie within `range_cells`.
enum { NEIGHBOURS_MAX_RANGE_CELLS = 2 };

/// Counting sort by cell: fills neighbours->cells. Stable, so sorted stays sorted.
void mf_neighbours_sort(struct neighbours *neighbours, const struct particles *particles);

/// Build the list of sorted particles. Fails: NO_MEMORY.
enum status mf_neighbours_build(struct neighbours *neighbours,
                                const struct particles *particles) MUST_USE;

// Particles as the neighbour search reads them: rows of cells with images at both ends.

/// Fails: NO_MEMORY.
enum status mf_neighbours_init_rows(struct neighbours *neighbours, const struct box *box) MUST_USE;

void mf_neighbours_clear_rows(struct neighbours *neighbours);
