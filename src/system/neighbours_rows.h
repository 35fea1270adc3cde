// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Particles as the neighbour search reads them: rows of cells with images at both ends.
#pragma once

#include "system/neighbours.h"

/// Fails: NO_MEMORY.
enum status mf_neighbours_init_rows(struct neighbours *neighbours, const struct box *box) MUST_USE;
void mf_neighbours_clear_rows(struct neighbours *neighbours);

/// Copy sorted particles into the rows.
void mf_neighbours_fill_rows(struct neighbours *neighbours, const struct particles *particles);
