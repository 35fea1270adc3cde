// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is measured of the forces of frames: the normal equations of force matching. Nothing
/// is done where they are not asked for; frames without forces are passed over.
#pragma once

#include "measure/measured.h"

/// Fewer frames with forces tell no errors.
enum { MEASURED_FORCES_FEWEST = 8 };

/// Choose the nodes by the first frame with forces, once there is one. Fails: as
/// mf_frame_forces_begin; BAD_INPUT if the range is longer than the box allows, or many frames have
/// no forces.
enum status mf_measured_forces_begin(struct measured *measured,
                                     const struct trajectory_frame *frames, size_t count) MUST_USE;

/// Of a frame of beads with its places, by any thread. Fails: NO_MEMORY.
enum status mf_measured_forces_look(const struct measured *measured,
                                    struct measured_slot *slot) MUST_USE;

/// Add it, in the order of frames.
void mf_measured_forces_add(struct measured *measured, const struct measured_slot *slot);

/// Whether there were enough of them. Fails: BAD_INPUT, naming the file.
enum status mf_measured_forces_check(const struct measured *measured, const char *file) MUST_USE;
