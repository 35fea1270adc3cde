// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The hypernetted-chain relation between g(r) and the potential.
#pragma once

#include "observe/rdf.h"

/// Indirect correlations h − c at the bin centres, from Ornstein and Zernike's equation,
///   ĥ_ab = ĉ_ab + Σ_t ĉ_at ρ_t ĥ_tb,
/// with h = g − 1, −1 below the first bin and 0 beyond the last. With the matrix of the structure
/// factors, S_ab = δ_ab + sqrt(ρ_a ρ_b) ĥ_ab, that of h − c times sqrt(ρ_a ρ_b) is (S − 1)² S⁻¹;
/// of one component h − c is ρ ĥ²/(1 + ρ ĥ). The hypernetted-chain potential is then Φ =
/// k_B T (−ln g + h − c): J.-P. Hansen and I. R. McDonald, Theory of Simple Liquids (4th ed.,
/// 2013), eq. 4.3.19. The sine transform of constant pieces is exact, whatever the bins.
/// A target that ends before its oscillations may make an eigenvalue of S negative at small q, and
/// noise makes its inverse anything there: it counts as no less than 0.1.
/// @param[in]  g         shape [pairs, bins.count]
/// @param[out] indirect  shape [pairs, bins.count]
/// Fails: BAD_INPUT but in three dimensions; NO_MEMORY. Tested: test_hnc_closure.
enum status mf_hnc_closure(const struct rdf_bins *bins, const struct box *box,
                           const struct composition *composition, const double *g,
                           double *indirect) MUST_USE;

/// Change of h − c with g, to first order, δS − S⁻¹ δS S⁻¹: between eigenvectors i and j of S, with
/// eigenvalues s, the transform is (1 − 1/(s_i s_j + ε²)) times that of h. At small q a liquid's S
/// is so small that the noise of g would become a potential; ε, as a structure factor, keeps that
/// bounded (Tikhonov).
///   F. Delbary, M. Hanke and D. Ivanizki, J. Inverse Ill-Posed Probl. 28 (2020).
/// @param[in]  g           shape [pairs, bins.count], where S is taken
/// @param[in]  difference  of g, the same shape
/// @param[out] indirect    the same shape
/// Fails: as mf_hnc_closure. Tested: test_hnc_closure.
enum status mf_hnc_closure_slope(const struct rdf_bins *bins, const struct box *box,
                                 const struct composition *composition, const double *g,
                                 const double *difference, double ridge, double *indirect) MUST_USE;
