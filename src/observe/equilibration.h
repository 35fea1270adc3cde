// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where a series of samples begins to be in equilibrium.
#pragma once

#include <stddef.h>

/// How many samples at the beginning are not in equilibrium; 0: nothing says so.
///
/// Of all beginnings up to half of the series, that one after which the mean has the least standard
/// error: K. P. White, Simulation 69, 323 (1997), with the correlation of samples as J. D. Chodera,
/// J. Chem. Theory Comput. 12, 1799 (2016), has it. Differs from both: chance alone makes some s
/// the best, also of a series in equilibrium; therefore nothing is left out unless the mean of the
/// first s samples, or of a part of them, is off from that of the others by Student's t of a
/// probability of 10⁻⁷, both with the variance and the inefficiency of the others.
///
/// Of 4000 series of 200 to 1000 samples in equilibrium, with a memory of up to a twentieth of
/// them, fewer than 1 in 100 lose a sample.
/// Fewer than 20 samples are all kept. Tested: test_equilibration.
/// @param[in] series  shape [samples]
size_t mf_equilibration_length(const double *series, size_t samples);

/// The same of events that equilibrium hardly has, as of beads that overlap: in the second half
/// there are none. The first samples, up to the last with an event, are not in equilibrium if
/// chance would put as many events there as one sample has in less than one of 10⁴ series: those of
/// different samples may be the same event that lasts.
/// @param[in] events  shape [samples]: how many each has
size_t mf_equilibration_length_of_events(const double *events, size_t samples);
