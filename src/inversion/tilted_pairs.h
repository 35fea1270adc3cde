// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Pairs of single beads in a box that is not rectangular, as another engine has it: counts
/// and sums as a force pass finds them in one that is.
#pragma once

#include "forces/pair.h"
#include "system/cell_pairs.h"
#include "system/composition.h"

/// Memory is used again; all zero is none.
struct tilted_pairs {
    struct cell_pairs search;
    int32_t *place[3]; ///< shape [beads]
    uint32_t *counts;  ///< shape of the bins, of the last configuration
    size_t beads;
};
void mf_tilted_pairs_clear(struct tilted_pairs *pairs);

/// Count the pairs of a configuration, and sum Φ and r·F over them.
/// @param[in] share  of each vector of the box, by id, shape [3][beads]
/// @param[in] bins   `counts` is not read
/// Fails: BAD_INPUT for a box in which the cutoff, or the bins, reach beyond half the least height;
/// NO_MEMORY. Tested: test_tilted_pairs, against all images.
enum status mf_tilted_pairs_count(struct tilted_pairs *pairs, const struct box_vectors *box,
                                  double *const share[3], const struct composition *composition,
                                  const struct table *potential, const struct pair_histogram *bins,
                                  struct pair_sums *sums) MUST_USE;
