// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Who is close to the particles of one cell: the inner loop of list building.
#pragma once

#include "system/neighbours.h"

/// A cell and the runs of consecutive particles around it. In a half list the first run begins with
/// the cell itself; the others are wanted whole.
struct close_cell {
    size_t begin, end; ///< its particles
    size_t around;     ///< particles in all runs
    int count;
    struct close_run {
        size_t begin, end;
    } * run;
};

/// Append the neighbours of the particles of `cell` to the list from place `used` on, and set their
/// `start`, `stop` and rows.
/// @param[in] limit  first place of the list that must not be written
/// @return the new length of the list, or SIZE_MAX if there might not be room
size_t close_portable(struct neighbours *neighbours, const struct particles *particles,
                      const struct close_cell *cell, size_t used, size_t limit);
size_t close_avx2(struct neighbours *neighbours, const struct particles *particles,
                  const struct close_cell *cell, size_t used, size_t limit);
size_t close_avx512(struct neighbours *neighbours, const struct particles *particles,
                    const struct close_cell *cell, size_t used, size_t limit);
