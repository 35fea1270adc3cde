// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What each frame of a trajectory has, in few numbers, to find out where it is in
/// equilibrium: pairs of beads in ranges of their distance, and the volume.
///
/// Memory does not grow with the trajectory: neighbouring frames are joined to blocks, twice as
/// many in each whenever all blocks are taken.
#pragma once

#include "measure/frame_pairs.h"
#include "observe/equilibration.h"

/// Ranges of the distance of one pair type, as many of pairs of different molecules as of pairs
/// within them; blocks.
enum { FEATURE_RANGES = 32, FEATURE_BLOCKS = 1024 };

/// All zero is none.
struct frame_features {
    size_t features;     ///< of a frame
    double *block;       ///< shape [FEATURE_BLOCKS, features]: sums over the block's frames
    size_t frames, each; ///< so far; of a block
};

/// Add a frame. Fails: NO_MEMORY.
/// @param[in] pairs   counted of it (mf_frame_pairs_count, mf_frame_pairs_exclude)
/// @param[in] volume  of its box [nm³]
enum status mf_frame_features_add(struct frame_features *features,
                                  const struct frame_pairs_plan *plan,
                                  const struct frame_pairs *pairs, double volume) MUST_USE;

void mf_frame_features_clear(struct frame_features *features);

/// What is the farthest from equilibrium.
struct frame_features_slowest {
    size_t frames; ///< at the beginning that are not in equilibrium (observe/equilibration.h)
    bool drifts;   ///< along the frames, by more than chance
    struct equilibration_drift drift; ///< pairs of a frame, or volumes [nm³]
    bool volume;                      ///< it is the volume; else pairs
    bool within;                      ///< of one molecule
    int pair;                         ///< of these types
    double from, to;                  ///< at this distance [nm]
};

/// What is the last to reach equilibrium after a beginning. Fails: NO_MEMORY. Tested:
/// test_frame_features.
enum status mf_frame_features_assess(const struct frame_features *features,
                                     const struct frame_pairs_plan *plan,
                                     struct frame_features_slowest *slowest) MUST_USE;

/// What drifts most along the frames from number `begin` on. Fails: NO_MEMORY. Tested:
/// test_frame_features.
enum status mf_frame_features_drift(const struct frame_features *features,
                                    const struct frame_pairs_plan *plan, size_t begin,
                                    struct frame_features_slowest *slowest) MUST_USE;
