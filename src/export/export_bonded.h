// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Bonds, angles and dihedrals for another engine: numbers of their laws, and tables of those
/// that it has not.
#pragma once

#include "export/export_model.h"

/// A law's energy and slope on rows that are equally far apart: of a bond from 0 to beyond what its
/// own table has, of an angle from 0 to π, of a dihedral from −π on, the last row one spacing
/// before π.
struct export_bonded_table {
    double *q;              ///< shape [rows] [λ] or [rad]; NULL: no table is wanted
    double *energy, *slope; ///< shape [rows] [k_B T_0], [k_B T_0/λ] or [k_B T_0/rad]
    int number;             ///< among the tables of its order, from 0 on
};

/// All zero: none.
struct export_bonded {
    int tables;
    size_t rows; ///< of each table; of dihedrals one less
    struct export_bonded_table table[BONDED_KINDS][MOLECULES_MAX_GROUPS];
    double energy_error, slope_error; ///< the worst, linear between rows: [k_B T], of the largest
};

/// Make the tables of the laws of a model that `has_law` denies: of so many rows that what is
/// linear between them is right within EXPORT_PHI_BOUND and EXPORT_FORCE_BOUND wherever the energy
/// is at most EXPORT_ACCESSIBLE k_B T above its least one. A model without molecules has none.
/// Fails: NO_MEMORY; BAD_INPUT if even the longest table does not meet the bounds. Tested:
/// cli/test_export_molecules.
enum status mf_export_bonded_make(struct export_bonded *bonded, const struct export_model *model,
                                  bool (*has_law)(const struct bonded_curve *curve)) MUST_USE;
void mf_export_bonded_clear(struct export_bonded *bonded);

/// Rows of a table of that order.
static inline size_t export_bonded_rows(const struct export_bonded *bonded, int order) {
    return mf_bonded_kinds[order]->periodic ? bonded->rows - 1 : bonded->rows;
}

/// The longest bond of the model's configuration [λ].
double mf_export_bonded_longest(const struct export_model *model);
