// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The box of a frame, and the places of beads in it (system/box_vectors.h).
#pragma once

#include "system/box_vectors.h"
#include "trajectory/frame.h"

/// Fails: BAD_INPUT, naming the frame, if it has no box or is not periodic in all of it.
enum status mf_frame_box_find(struct box_vectors *box,
                              const struct trajectory_frame *frame) MUST_USE;

/// Fails: BAD_INPUT, naming the frame, if `range` is beyond half the least height; `what` says
/// whose range it is. Tested: test_frame_pairs.
enum status mf_frame_box_check_range(const struct box_vectors *box,
                                     const struct trajectory_frame *frame, double range,
                                     const char *what) MUST_USE;

/// Fractions of the positions; place[i] has shape [frame->atoms]. Fails: BAD_INPUT, naming frame
/// and bead, if one is so many boxes away that its place in a box is lost. Tested:
/// test_frame_pairs.
enum status mf_frame_box_places(const struct box_vectors *box, const struct trajectory_frame *frame,
                                int32_t *const place[3]) MUST_USE;

/// How far the atoms of a frame spread along each vector, in boxes: sqrt(12) times their standard
/// deviation, which is 1 of atoms that fill the box evenly, wrapped or not.
void mf_frame_box_spread(const struct box_vectors *box, const struct trajectory_frame *frame,
                         double spread[3]);
