// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Waves of the density of a frame's beads: the structure factor at vectors of the reciprocal
/// lattice of its own box.
#pragma once

#include "measure/frame_box.h"
#include "observe/structure_factor.h"

/// Memory of one thread, used again for every frame; all zero is none.
struct frame_waves {
    struct density_waves waves;
    double *numbers; ///< of this frame, for mf_structure_factor_add
};

/// Find S of a frame. @param[in] place  shape [3][beads]: mf_frame_box_places
/// Fails: BAD_INPUT, without a place, for too many waves, or none; NO_MEMORY. Tested:
/// test_measured.
enum status mf_frame_waves_find(struct frame_waves *waves, const struct density_waves_plan *plan,
                                const struct frame_box *box, int32_t *const place[3]) MUST_USE;

void mf_frame_waves_clear(struct frame_waves *waves);
