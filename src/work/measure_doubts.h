// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a trajectory shows to be in another unit.
#pragma once

#include "report/progress.h"
#include "trajectory/frame.h"
#include "work/measure_output.h"

/// Warn of a density that no matter has, where units were told, and of a box that the atoms do not
/// fill, or that they do not go into. Tested: cli/test_measure_words.
/// @param[in] units  that were told, or NULL
void mf_measure_doubts(struct progress *progress, const struct trajectory_frame *frame,
                       size_t beads, const char *units);

/// Warn of a density that no liquid has whose pairs are so close, and of motion that velocities
/// contradict. Fails: NO_MEMORY. Tested: cli/test_measure_words.
enum status mf_measure_doubt_results(struct progress *progress,
                                     const struct measure_result *result) MUST_USE;

/// Warn of frames that are wanted further apart than they are, and come at common multiples of both
/// times. @param[in] count  of those that were read first
void mf_measure_doubt_interval(struct progress *progress, const struct frames *frames,
                               size_t count);

/// Say that frames are too few to tell equilibrium.
void mf_measure_doubt_few(struct progress *progress, size_t frames);
