// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The box of a frame, of any shape, and the places of beads in it.
///
/// A place is a fraction of each vector of the box in units of 2⁻³² (box_fraction): the difference
/// of two, taken with wrap-around, is d = Σ_i s_i v_i with −½ ≤ s_i < ½, one of the images of the
/// separation. It is the right one wherever it matters: an image of length r has
///   |s_i| = |d · u_i| ≤ r |u_i| = r/h_i
/// with u_i the reciprocal vectors, 1/|u_i| = h_i the heights of the box. If r < h_i/2 for all i,
/// then all |s_i| < ½, and there is but one image with such fractions: the one that is taken. So
/// all pairs nearer than half the least height are found, each once, at their distance; beyond, the
/// image that is taken may not be the nearest.
///
/// Distances depend on s through the products v_i · v_j alone. `edge` is their Cholesky factor, the
/// box turned so that its first vector lies along x and its second in the plane of x and y:
///   r² = |s L|²,   L Lᵀ = (v_i · v_j).
#pragma once

#include "system/box.h"
#include "trajectory/frame.h"

struct frame_box {
    double edge[3][3];    ///< L, lower triangular [nm]
    double inverse[3][3]; ///< fraction i of a position is its product with row i [1/nm]
    double height[3];     ///< between opposite faces [nm]
    double volume;        ///< [nm³]
};

/// Fails: BAD_INPUT, naming the frame, if it has no box or is not periodic in all of it.
enum status mf_frame_box_find(struct frame_box *box, const struct trajectory_frame *frame) MUST_USE;

/// The least of the heights [nm].
double mf_frame_box_min_height(const struct frame_box *box);

/// Fails: BAD_INPUT, naming the frame, if `range` is beyond half the least height; `what` says
/// whose range it is. Tested: test_frame_pairs.
enum status mf_frame_box_check_range(const struct frame_box *box,
                                     const struct trajectory_frame *frame, double range,
                                     const char *what) MUST_USE;

/// Fractions of the positions; place[i] has shape [frame->atoms]. Fails: BAD_INPUT, naming frame
/// and bead, if one is so many boxes away that its place in a box is lost. Tested:
/// test_frame_pairs.
enum status mf_frame_box_places(const struct frame_box *box, const struct trajectory_frame *frame,
                                int32_t *const place[3]) MUST_USE;
