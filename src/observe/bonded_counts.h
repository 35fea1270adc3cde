// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What an observable of bonds, angles or dihedrals has counted.
#pragma once

#include "observe/bonded_distribution.h"
#include "observe/sample_blocks.h"

struct bonded_state {
    const struct molecules *molecules;
    int order;
    int dimensions;
    struct sample_blocks blocks;                   ///< of counts in the bins of all groups
    struct bonded_bins bins[MOLECULES_MAX_GROUPS]; ///< of each group
    size_t first[MOLECULES_MAX_GROUPS + 1];        ///< bin of each group among those of all
    size_t parts;                                  ///< of the molecules
    double *of_part;                               ///< shape [parts, bins of all groups]
};

/// Blocks that all states have.
size_t mf_bonded_series_blocks(const struct bonded_state *const *states, size_t count);

/// p of a group's bins in blocks of time and independent states, shape [bins, count, blocks].
void mf_bonded_series_find(const struct bonded_state *const *states, size_t count, int group,
                           size_t blocks, double *series);
