// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Beads as GSD of HOOMD-blue: nm, ps and u, which the file does not say; positions in the
/// box with images. Frame 0 has what beads are, the index of all frames stands at the end.
#pragma once

#include "trajectory/beads_file.h"

/// Fails: BAD_INPUT without a box, for one that the format has not, and without velocities if the
/// first frame had them.
enum status mf_beads_gsd_print(struct beads_file *file,
                               const struct trajectory_frame *beads) MUST_USE;

/// After the last frame.
void mf_beads_gsd_finish(struct beads_file *file);
