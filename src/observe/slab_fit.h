// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The two densities and the interface of a slab, from a density profile about its middle.
///
/// Least squares give the place h and the scale w of both interfaces, taken to be alike:
///   ρ(z) = a − b tanh((|z| − h)/w).
/// An interface is not quite a tanh, whose misfit is little of the liquid's density but much of a
/// thin vapour's: the densities are means of the profile on the plateaus, more than 3 w from h,
/// where a tanh has come within 0.25 % of the step to its end.
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct slab_fit {
    double place, scale; ///< h and w [λ]
    double middle, half; ///< a and b [1/λ^d]
    double liquid;       ///< mean on the plateau |z| < h − 3 w; NaN where there is none
    double vapour;       ///< mean on the plateau |z| > h + 3 w, the same
    double width;        ///< between 10 and 90 % of the tanh's step, 2.2 w [λ]
    size_t liquid_bins, vapour_bins; ///< of the plateaus
};

/// @param[in] density  shape [bins], equal bins over z from −length/2 to length/2
/// @param[in] near     the fit of a profile that differs by little, to begin with; NULL: none
/// Tested: test_slab_fit.
struct slab_fit mf_slab_fit(const double *density, size_t bins, double length,
                            const struct slab_fit *near);

/// The curve itself.
double mf_slab_fit_value(const struct slab_fit *fit, double z);

/// Whether both plateaus are there, of two bins at least, and differ by more than five standard
/// deviations of particles that lie at random on both sides of h in one configuration: what a fluid
/// without an interface shows is less steep, since all that is common to its configurations, each
/// about its own middle, is the longest wave.
/// @param[in] volume  of the box [λ^d]
/// Tested: test_slab_fit.
bool mf_slab_fit_is_slab(const struct slab_fit *fit, double length, double volume, double count);

/// A profile block by block, for its scatter.
struct slab_blocks {
    const double *sums;    ///< shape [count, row], the bins first: densities, over the samples
    const double *samples; ///< shape [count]
    size_t count, row;     ///< at most SLAB_MAX_BLOCKS
};
enum { SLAB_MAX_BLOCKS = 40 };

/// Whether the density, along the axis, rises through the half of the step and falls through it,
/// and does not rise again, as it does with two slabs, or one with a hole in it. It is above or
/// below the half where the mean over a window, w wide or 2, 4, … times that, is so by more than
/// five standard deviations: by the scatter of the blocks, and of particles at random in a
/// configuration of each. Tested: test_slab_fit.
bool mf_slab_fit_rises_once(const struct slab_fit *fit, const struct slab_blocks *blocks,
                            size_t bins, double length, double volume);
