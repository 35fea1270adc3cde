// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Who is close to the particles of one cell: the inner loop of list building.
#pragma once

#include "system/neighbours.h"

/// A cell and the runs of consecutive particles around it, in ascending order.
struct close_cell {
    size_t begin, end; ///< its particles
    int count;
    struct close_run {
        size_t begin, end;
    } * run;
};

/// Append the neighbours of the particles of `cell` to neighbours->list, which has room for all
/// that could be found and PARTICLES_PADDING more, from place `used` on, and set their `start`.
/// @return the new length of the list
size_t close_portable(struct neighbours *neighbours, const struct particles *particles,
                      const struct close_cell *cell, size_t used);
size_t close_avx2(struct neighbours *neighbours, const struct particles *particles,
                  const struct close_cell *cell, size_t used);
size_t close_avx512(struct neighbours *neighbours, const struct particles *particles,
                    const struct close_cell *cell, size_t used);
