// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Kirkwood and Buff's integral of a g(r), and the compressibility that it says.
#pragma once

#include "observe/rdf.h"

struct kirkwood_buff {
    double integral, integral_error;               ///< G [λ³]
    double compressibility, compressibility_error; ///< ρ k_B T κ_T = 1 + ρ G = S(0) [1]
};

/// G = ∫ (g − 1) d³r of the infinite system, extrapolated from what is known up to the range L of
/// the bins:
///   G ≈ ∫_0^L (g − 1) 4π r² u(r/L) dr,   u(x) = 1 − 23x³/8 + 3x⁴/4 + 9x⁵/8.
/// P. Krüger and T. J. H. Vlugt, Phys. Rev. E 97, 051301 (2018), whose u makes of the integrals
/// over finite spheres (P. Krüger et al., J. Phys. Chem. Lett. 4, 235 (2013)) what converges as
/// 1/L³. The integral over each bin is exact for constant g in it; below the first g is 0. Pairs
/// that g leaves out, as those that molecules exclude, are near each other and belong to G:
/// `inside` is what they add to it. Of N particles g normalised by N (N − 1) has a tail of −ρG/N
/// (observe/finite_size.h), which is taken out:
///   ρG = I/(1 − ∫ 4π r² u dr/V),   I the integral, and what is inside, times ρ.
/// Errors of bins count as independent; those by sampling compensate each other in a liquid, which
/// makes the standard error too large rather than too small.
/// @param[in] g, error   shape [bins.count]; an error that is NaN counts as 0
/// @param[in] box, count  of the system that g comes from, in three dimensions
/// @param[in] inside      volume times the share of all pairs that g leaves out [λ³]
/// Tested: test_kirkwood_buff.
struct kirkwood_buff mf_kirkwood_buff_integrate(const struct rdf_bins *bins, const double *g,
                                                const double *error, const struct box *box,
                                                size_t count, double inside);
