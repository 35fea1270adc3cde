// SPDX-License-Identifier: GPL-3.0-or-later
/// @file U(q) through given points: the law "table" of bonds, angles and dihedrals.
#pragma once

#include "curves/bonded_law.h"

struct bonded_table {
    char file[FIELD_TEXT_SIZE]; ///< where the points came from; "" if from memory
    double first, spacing;      ///< of the grid that is read, in q
    int intervals;
    bool periodic;      ///< of a dihedral, which has no ends
    double (*point)[2]; ///< shape [intervals + 1]: U and dU/dq · spacing; NULL: no points yet
    double rest;        ///< the grid's q of the least U
};

static inline bool bonded_is_table(const struct bonded_law *law) {
    return law == &mf_bonded_table_bond || law == &mf_bonded_table_angle ||
           law == &mf_bonded_table_dihedral;
}

/// Give a curve of such a law its points: a cubic spline through them, natural or, of a dihedral,
/// periodic. Below the first and beyond the last the energy goes on as a straight line.
/// @param[in] q  shape [count], growing: lengths [λ], or angles [degrees], which for a dihedral
///               span 360 and have the same U at both ends
/// @param[in] energy  shape [count] [k_B T_0]
/// Fails: BAD_INPUT, NO_MEMORY. Tested: test_bonded_law.
enum status mf_bonded_table_set_points(struct bonded_curve *curve, const double *q,
                                       const double *energy, size_t count) MUST_USE;
