// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The configurational temperature, fast enough to be looked at in every sample.
#pragma once

#include "curves/table.h"
#include "system/neighbours.h"

/// Configurational temperature Σ_i |F_i|² / Σ_i ∇_i² U [k_B T_0] from the potential alone.
///   Σ_i ∇_i² U = 2 Σ_pairs [Φ''(r) + (d − 1) Φ'(r)/r]
/// and, where the force of a pair type ends abruptly at its cutoff, the jump of the slope
/// there, which needs to know the temperature roughly. H. H. Rugh, Phys. Rev. Lett. 78, 772 (1997);
/// O. G. Jepps, G. Ayton and D. J. Evans, Phys. Rev. E 62, 4757 (2000), eq. 37. It sees positions
/// only, so it shows errors of the time step that the kinetic temperature hides.
/// Where potentials act beside the pairs whose ∇²U is known (and added by the caller), F is of
/// both; where others do, with forces F', Σ F·(F + F') stands for Σ|F|²: the general expression of
/// Jepps et al. with the ∇U that is known for its vector field.
/// @param[in] neighbours  half list, complete for the cutoff of the potential
/// @param[in] known, others  forces beside the pairs, of both kinds, shape [dimensions][count], or
///                           both NULL: there are none
/// @param[out] squares    Σ F·(F + F') [(k_B T_0/λ)²]
/// @param[out] laplacian  Σ ∇_i² U [k_B T_0/λ²]; the temperature is ⟨squares⟩ / ⟨laplacian⟩
/// Fails: NO_MEMORY. Tested: test_configurational.
enum status mf_configurational(const struct table *potential, const struct composition *composition,
                               double temperature, const struct particles *particles,
                               const struct neighbours *neighbours, double *const *known,
                               double *const *others, double *squares, double *laplacian) MUST_USE;
