// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The factor by which a target's g(r) is too large as a whole.
///
/// A measured g is often off by half a percent: N or N − 1, a density, the volume of a slab. No
/// short-ranged potential makes such a g, but a ramp A (1 − r/r_c) of ten k_B T comes near it: with
/// a g of water that is 0.8 % too small, inverse Monte Carlo goes to a pressure of a hundred times
/// the right one. What betrays the factor is theory: the potential that Ornstein and Zernike's
/// equation and the hypernetted chain make of g/ν has a tail of several k_B T, or a compressibility
/// that no liquid has, as soon as ν is off by two tenths of a percent.
#pragma once

#include "observe/rdf.h"

struct normalisation {
    double factor, error;   ///< ν, 1 where nothing contradicts it, and its standard error
    bool found;             ///< the target excludes 1
    double compressibility; ///< S(0) of g/ν; NaN: not known
};

/// The factor of a target:
///   minimise  [(ν − 1)/width]² + [ln(S(0)/S_0)/s]² + [Φ_tail/(t k_B T)]²
/// with S(0) and the hypernetted chain's Φ of g/ν (mf_ornstein_zernike_solve), Φ_tail its mean over
/// the last tenth of the range but for that of a parabola, and S_0 that of hard spheres as large as
/// the core (N. F. Carnahan and K. E. Starling, J. Chem. Phys. 51, 635 (1969)). ν = 1 is kept
/// unless this is larger there by more than six and ν two of its standard errors away. Of a mixture
/// it takes the g of all beads, and one factor. In two dimensions, and of a g(r) that ends
/// before 1.8 mean distances, ν is 1. Noise of the target widens s and t.
/// @param[in] g, error  shape [pairs, bins.count], of the system in the box
/// @param[in] width  standard deviation of ν about 1 before any measurement
/// Fails: NO_MEMORY. Tested: test_normalisation.
enum status mf_normalisation_find(const struct rdf_bins *bins, const struct box *box,
                                  const struct composition *composition, const double *g,
                                  const double *error, double width,
                                  struct normalisation *normalisation) MUST_USE;
