// SPDX-License-Identifier: GPL-3.0-or-later
/// @file U(q) through given points: the law "table" of each kind of bonded terms.
#pragma once

#include "curves/bonded_kind.h"

#include <stddef.h>

struct bonded_table {
    char file[FIELD_TEXT_SIZE]; ///< where the points came from; "" if from memory
    double first, spacing;      ///< of the grid that is read, in q
    int intervals;
    bool periodic;      ///< of a dihedral, which has no ends
    double (*point)[2]; ///< shape [intervals + 1]: U and dU/dq · spacing; NULL: no points yet
    double rest;        ///< the grid's q of the least U
};

static inline bool bonded_is_table(const struct bonded_law *law) {
    return mf_bonded_kind_of_table(law) != NULL;
}

/// Give a curve of such a law its points: a cubic spline through them, natural or, of a dihedral,
/// periodic. Below the first and beyond the last the energy goes on as a straight line.
/// @param[in] q  shape [count], growing: lengths [λ], or angles [degrees], which for a dihedral
///               span 360 and have the same U at both ends
/// @param[in] energy  shape [count] [k_B T_0]
/// Fails: BAD_INPUT, NO_MEMORY. Tested: test_bonded_law.
enum status mf_bonded_table_set_points(struct bonded_curve *curve, const double *q,
                                       const double *energy, size_t count) MUST_USE;

/// Whether the spline has no well that its points do not show: between two of them it must not go
/// below both by more than 1 k_B T_0 and by more than their difference and the lesser of those to
/// the points beside, where a bead may come, up to 10 k_B T_0 above the least point. The spline of
/// a table with a step rings about it by a tenth of its height; that of a smooth well goes below
/// two points by an eighth of what it rises beside them. Fails: BAD_INPUT with the points. Tested:
/// test_bonded_law.
enum status mf_bonded_table_check_wells(const struct bonded_curve *curve, const double *q,
                                        const double *energy, size_t count) MUST_USE;

void mf_bonded_table_evaluate(const void *parameters, size_t count, const double *q, double *energy,
                              double *slope);
double mf_bonded_table_rest(const void *parameters);
void mf_bonded_table_clear(void *parameters);

/// Define the law of a kind.
#define BONDED_TABLE(record, columns, text)                                                        \
    static const struct field table_fields[] = {{"file", FIELD_FILE,                               \
                                                 .offset = offsetof(struct bonded_table, file),    \
                                                 .required = true, .unit = "", .help = columns},   \
                                                FIELD_END};                                        \
    const struct bonded_law record = {.name = "table",                                             \
                                      .summary = text,                                             \
                                      .fields = table_fields,                                      \
                                      .size = sizeof(struct bonded_table),                         \
                                      .evaluate = mf_bonded_table_evaluate,                        \
                                      .rest = mf_bonded_table_rest,                                \
                                      .clear = mf_bonded_table_clear}
