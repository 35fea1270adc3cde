// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The vectors of a periodic box of any shape, and places in it.
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

struct box_vectors {
    double edge[3][3];    ///< L, lower triangular [length]
    double inverse[3][3]; ///< fraction i of a position is its product with row i [1/length]
    double height[3];     ///< between opposite faces [length]
    double volume;        ///< or area [length^d]
};

/// Of a rectangular box; in two dimensions there is no fraction along the third.
struct box_vectors mf_box_vectors_of(const struct box *box);

/// The least of the heights.
double mf_box_vectors_min_height(const struct box_vectors *vectors);
