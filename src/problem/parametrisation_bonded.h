// SPDX-License-Identifier: GPL-3.0-or-later
/// @file U(q) of a group of bonds, angles or dihedrals, made of coefficients:
///
///   U(q) = U_0(q) + Σ_k c_k (B_k(q) − ⟨B_k⟩),
///
/// with U_0 the Boltzmann inversion of the target (mf_bonded_grid_start), which has its detail, and
/// B_k few functions: cubic B-splines over the bins that are known, of a dihedral cos φ, sin φ,
/// cos 2φ and so on. A constant of U changes nothing: means ⟨B_k⟩ over the target hold it.
#pragma once

#include "problem/bonded_grid.h"

/// B_k − ⟨B_k⟩ at the known bins. Fails: NO_MEMORY. Tested: test_parametrisation_bonded.
/// @param[out] basis  shape [grid->known, count]
enum status mf_parametrisation_bonded_basis(const struct bonded_grid *grid, size_t count,
                                            double *basis) MUST_USE;

/// Standard errors of U_0 by those of the target, as far as no coefficients and no constant can
/// make up for them, at the known bins: with Σ = diag((k_B T σ/p)²) of U_0 and the basis B, a
/// constant in it, the diagonal of Σ − B (Bᵀ Σ⁻¹ B)⁻¹ Bᵀ. Fails: NO_MEMORY. Tested:
/// test_parametrisation_bonded.
/// @param[in]  target_error  σ of the target's bins
/// @param[in]  basis         of the coefficients of the group
/// @param[out] error         shape [grid->known] [k_B T_0]
enum status mf_parametrisation_bonded_rough(const struct bonded_grid *grid,
                                            const double *target_error, const double *basis,
                                            double *error) MUST_USE;
