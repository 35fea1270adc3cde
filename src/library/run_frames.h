// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Frames in the caller's memory, for the reader of trajectories.
#pragma once

#include "mesofit/run.h"
#include "trajectory/trajectory_memory.h"

/// Zeros are none. Must not be moved.
struct run_frames {
    struct structure structure;
    struct trajectory_memory memory_files;
    const struct mesofit_trajectory *from;
};

/// Fails: BAD_INPUT for a trajectory without atoms, names, or units; NO_MEMORY.
enum status mf_run_frames_begin(struct run_frames *frames,
                                const struct mesofit_trajectory *from) MUST_USE;
void mf_run_frames_end(struct run_frames *frames);
