// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Styles of bonds, angles and dihedrals of LAMMPS, and the laws that they are (manual,
/// bond_style, angle_style, dihedral_style).
#pragma once

#include "curves/bonded_kind.h"

enum { LAMMPS_MAX_NUMBERS = 8 };

/// Make the curve of a style from the numbers after its name in a line of coefficients.
/// @param[in]  length, energy  the file's units in λ and k_B T_0
/// @param[out] note  what is not taken, or NULL
/// Fails: BAD_INPUT, without file and line, for a style that is not known, another count of
/// numbers, or one that its law cannot have; NO_MEMORY. Tested: cli/test_lammps_topologies.
enum status mf_lammps_style_create(struct bonded_curve *curve, int order, const char *style,
                                   const double *number, int count, double length, double energy,
                                   const char **note) MUST_USE;
