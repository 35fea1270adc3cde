// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the first frame of a trajectory shows to be in another unit.
#pragma once

#include "report/progress.h"
#include "trajectory/frame.h"

/// Warn of a density that no matter has, where units were told, and of a box that the atoms do not
/// fill, or that they do not go into. Tested: cli/test_measure_words.
/// @param[in] units  that were told, or NULL
void mf_measure_doubts(struct progress *progress, const struct trajectory_frame *frame,
                       size_t beads, const char *units);
