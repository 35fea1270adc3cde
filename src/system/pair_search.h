// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Who is close to the particles of one row of cells: the inner loops of list building.
#pragma once

#include "system/neighbours.h"

enum { PAIR_SEARCH_MAX_ROWS = 25 };

/// The cells of a row, and the rows that are searched for their neighbours, itself first.
struct pair_search_rows {
    size_t first; ///< particle of the first cell
    int cells;    ///< without the margins of struct neighbours_rows
    int margin;
    int count;
    struct pair_search_row {
        const uint32_t *start; ///< of the first cell in the box: neighbours_rows.start
        int depth;             ///< cells to search on both sides
        float shift[2];        ///< of this image along the first two axes [λ]
    } row[PAIR_SEARCH_MAX_ROWS];
};

/// Append the neighbours of the particles of a row to the list from place `used` on, and set their
/// `start`, `stop` and rows of entries.
/// @param[in] limit  first place of the list that must not be written
/// @return the new length of the list, or SIZE_MAX if there might not be room
size_t mf_pair_search_portable(struct neighbours *neighbours, const struct particles *particles,
                               const struct pair_search_rows *rows, size_t used, size_t limit);
size_t mf_pair_search_avx2(struct neighbours *neighbours, const struct particles *particles,
                           const struct pair_search_rows *rows, size_t used, size_t limit);
size_t mf_pair_search_avx512(struct neighbours *neighbours, const struct particles *particles,
                             const struct pair_search_rows *rows, size_t used, size_t limit);
