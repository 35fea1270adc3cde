// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The hypernetted-chain relation between g(r) and the potential.
#pragma once

#include "observe/rdf.h"

/// Indirect correlation h − c at the bin centres, from Ornstein and Zernike's equation,
///   ĥ = ĉ + ρ ĉ ĥ,   so that the transform of h − c is ρ ĥ² / (1 + ρ ĥ),
/// with h = g − 1, −1 below the first bin and 0 beyond the last. The hypernetted-chain potential is
/// then Φ = k_B T (−ln g + h − c): J.-P. Hansen and I. R. McDonald, Theory of Simple Liquids (4th
/// ed., 2013), eq. 4.3.19. The sine transform of constant pieces is exact, whatever the bins.
/// 1 + ρ ĥ is S(q); a target that ends before its oscillations may make it negative at small q, so
/// and noise makes its inverse anything there: it counts as no less than 0.1.
/// @param[in]  g         shape [bins.count]
/// @param[out] indirect  shape [bins.count]
/// Fails: BAD_INPUT but in three dimensions. Tested: test_hnc_closure.
enum status hnc_closure(const struct rdf_bins *bins, const struct box *box, size_t count,
                        const double *g, double *indirect) MUST_USE;

/// Change of h − c with g, to first order: that of the transform is (1 − 1/(S² + ε²)) times that of
/// h. At small q a liquid's S is so small that the noise of g would become a potential; ε, as a
/// structure factor, keeps that bounded (Tikhonov).
///   F. Delbary, M. Hanke and D. Ivanizki, J. Inverse Ill-Posed Probl. 28 (2020).
/// @param[in]  g           shape [bins.count], where S is taken
/// @param[in]  difference  of g, shape [bins.count]
/// @param[out] indirect    shape [bins.count]
/// Fails: as hnc_closure. Tested: test_hnc_closure.
enum status hnc_closure_slope(const struct rdf_bins *bins, const struct box *box, size_t count,
                              const double *g, const double *difference, double ridge,
                              double *indirect) MUST_USE;
