// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The hypernetted-chain relation between g(r) and the potential.
#pragma once

#include "observe/rdf.h"

/// A liquid of beads, single or in molecules. All is borrowed.
struct hnc_liquid {
    const struct rdf_bins *bins;
    const struct box *box;
    const struct composition *composition;
    const double *inside; ///< counts of the pairs that molecules exclude over those of an ideal gas
                          ///< of N_a²/2 pairs of like beads, where g has N_a (N_a − 1)/2 of all
                          ///< others, shape [pairs, bins.count]; NULL: none
    double softness; ///< h may be missed by this times g² c: noise, and a level of g that is known
                     ///< within so much, would else become a ramp of several k_B T; 0: not at all
};

/// Indirect correlations h − c at the bin centres, from the equation of Ornstein and Zernike, or
/// of reference interaction sites (D. Chandler and H. C. Andersen, J. Chem. Phys. 57, 1930 (1972)),
///   H = Ω C Ω + Ω C H,  C = Ω⁻¹ − S⁻¹,  S = Ω + H,
/// with the matrices over the types H of sqrt(ρ_a ρ_b) ĥ_ab, C of ĉ alike, and Ω of the pairs of
/// one molecule that act on each other by their bonds alone: 1 of single beads. h is g − 1, −1
/// below the first bin, and beyond the last one as it follows from C, which ends there
/// (inversion/ornstein_zernike.h): a g(r) that ends before its oscillations do is so continued. Of
/// few particles g is what an infinite system would have: the numbers of beads in a box do not
/// vary, so that it is too small by the factor 1 − S_ab(0)/(V sqrt(ρ_a ρ_b)) (J. L. Lebowitz and
/// J. K. Percus, Phys. Rev. 122, 1675 (1961)). The hypernetted-chain potential is then Φ =
/// k_B T (−ln g + h − c): J.-P. Hansen and I. R. McDonald, Theory of Simple Liquids (4th ed.,
/// 2013), eq. 4.3.19.
/// @param[in]  g         shape [pairs, bins.count]
/// @param[out] indirect  shape [pairs, bins.count]
/// Fails: BAD_INPUT but in three dimensions; NO_MEMORY. Tested: test_hnc_closure,
/// test_hnc_closure_mixture, test_hnc_closure_molecules.
enum status mf_hnc_closure(const struct hnc_liquid *liquid, const double *g,
                           double *indirect) MUST_USE;

/// Change of h − c with g, to first order, δS − S⁻¹ δS S⁻¹: between eigenvectors i and j of S, with
/// eigenvalues s, of h that is 0 beyond the last bin, the transform is (1 − 1/(s_i s_j + ε²)) times
/// that of h. At small q a liquid's S is so small that the noise of g would become a potential; ε,
/// as a structure factor, keeps that bounded (Tikhonov).
///   F. Delbary, M. Hanke and D. Ivanizki, J. Inverse Ill-Posed Probl. 28 (2020); of molecules
///   M. P. Bernhardt, M. Hanke and N. F. A. van der Vegt, J. Chem. Phys. 154, 084102 (2021).
/// @param[in]  g           shape [pairs, bins.count], where S is taken
/// @param[in]  difference  of g, the same shape
/// @param[out] indirect    the same shape
/// Fails: as mf_hnc_closure. Tested: test_hnc_closure.
enum status mf_hnc_closure_slope(const struct hnc_liquid *liquid, const double *g,
                                 const double *difference, double ridge, double *indirect) MUST_USE;

/// The least eigenvalue of Ω at any q. Near 0, as of small molecules that exclude all their pairs,
/// g of the types are hardly independent at small q, and their differences noise.
/// Fails: NO_MEMORY. Tested: test_hnc_closure_molecules.
enum status mf_hnc_closure_min_intramolecular(const struct hnc_liquid *liquid,
                                              double *min) MUST_USE;
