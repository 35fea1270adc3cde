// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Pairs of beads in a frame: how many at which distance, and how dense it is around each.
#pragma once

#include "base/status.h"
#include "trajectory/frame.h"
#include "observe/weighted_density.h"
#include "system/composition.h"
#include "system/cell_pairs.h"

/// What is counted, the same for all frames.
struct frame_pairs_plan {
    double range; ///< of the bins, from 0 on [nm]
    size_t bins;
    struct composition composition; ///< beads stand in the order of their types
    const uint32_t *molecule; ///< shape [beads]: pairs of one molecule are left out; NULL: none is
    bool within;              ///< and counted apart
};

/// Memory of one thread, used again for every frame; all zero is none.
struct frame_pairs {
    struct cell_pairs search;
    int32_t *type;      ///< shape [beads]: in the order of cells, of a mixture
    uint32_t *molecule; ///< likewise, if pairs of one are left out
    uint64_t *counts;   ///< shape [pair types, bins + 1]; the last bin is of what is left out
    uint64_t *within;   ///< the same of pairs of one molecule, if these are counted
};

void mf_frame_pairs_clear(struct frame_pairs *pairs);

/// Count the pairs of a frame by type and distance, r < range, into pairs->counts.
/// @param[in] place  shape [3][beads]: mf_frame_box_places
/// The range is at most half the least height (mf_frame_box_check_range). Fails: NO_MEMORY.
/// Threads: one a struct frame_pairs. Tested: test_frame_pairs, against all images.
enum status mf_frame_pairs_count(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                                 const struct box_vectors *box, int32_t *const place[3]) MUST_USE;

/// Take pairs off those within molecules that were counted, and add to these the others: then
/// pairs->within has all pairs but those. Tested: cli/test_measure_molecules.
/// @param[in] excluded  shape [count, 2]: beads
void mf_frame_pairs_exclude(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                            int32_t *const place[3], uint32_t (*excluded)[2], size_t count);

/// Find the weighted density around each bead, of the pairs that are counted as those of different
/// molecules; or, if pairs within them are counted, of all but `excluded`.
/// @param[out] density  shape [beads]
/// Fails: NO_MEMORY. Tested: test_measured.
enum status mf_frame_pairs_weigh(struct frame_pairs *pairs, const struct frame_pairs_plan *plan,
                                 const struct weighted_density_settings *settings,
                                 const struct box_vectors *box, int32_t *const place[3],
                                 uint32_t (*excluded)[2], size_t count, double *density) MUST_USE;

/// How many pairs of each pair type there are to be counted: all but those of one molecule.
/// @param[out] possible  shape [pair types]
/// Fails: NO_MEMORY. Tested: test_frame_pairs.
enum status mf_frame_pairs_possible(const struct frame_pairs_plan *plan, double *possible) MUST_USE;
