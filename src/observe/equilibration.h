// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where a series of samples begins to be in equilibrium.
#pragma once

#include "base/status.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/// Fewer samples do not tell.
enum { EQUILIBRATION_MIN_SAMPLES = 20 };

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
/// Fewer than EQUILIBRATION_MIN_SAMPLES are all kept. Tested: test_equilibration.
/// @param[in] series  shape [samples]
size_t mf_equilibration_length(const double *series, size_t samples);

/// The same of events that equilibrium hardly has, as of beads that overlap: in the second half
/// there are none. The first samples, up to the last with an event, are not in equilibrium if
/// chance would put as many events there as one sample has in less than one of 10⁴ series: those of
/// different samples may be the same event that lasts.
/// @param[in] events  shape [samples]: how many each has
size_t mf_equilibration_length_of_events(const double *events, size_t samples);

/// How a series changes: where it splits best into two parts of different means.
struct equilibration_drift {
    double evidence;      ///< −lg of the chance that a series which does not change is so
    double part;          ///< of the samples that is before
    double before, after; ///< means
    double before_error, after_error;
};

/// Whether a series changes along its length: a way that goes on to its end, or a step anywhere.
///
/// The slope of a line through all samples, and the height of that one of 19 steps which leaves
/// least, are compared with their errors by what the samples are off that line or step: a change,
/// however strong, does not hide itself in its error. Errors are by the inefficiency g of what is
/// left (base/statistics.h), and Student's distribution has n/(4g) − 1 degrees of freedom, since g
/// is not known well either. The chance counts 2 tests, and the 19 steps. More than 512 samples are
/// joined to so many.
///
/// Where samples remember each other for long, the same is seen better by means m_b over B = 20
/// parts, the first k of which are compared with the others, for each k, by
///
///   |mean of k − mean of B − k| / (s sqrt(1/k + 1/(B − k))),
///
/// s² being the noise of a part: half of the mean of (m_{b+l} − m_b)² for l = 1 or 2, whichever is
/// larger, without the l largest squares, which a step has. Neighbours see little of a drift; where
/// samples remember each other over several parts, s grows with l. The largest ratio R counts as
/// an evidence of 3 + (R − 7.5)/2. 0 for fewer than
/// EQUILIBRATION_MIN_SAMPLES. Tested: test_equilibration_drift.
/// @param[in] series  shape [samples]
struct equilibration_drift mf_equilibration_drift(const double *series, size_t samples);

/// Whether the strongest evidence of so many series is drift, and no chance.
///
/// False alarms of one series: one in 1000 with a memory of up to a fiftieth of its length, in 100
/// with a twentieth; of 30 series together as few. Found, of 400 samples: ways of 1 and 2 standard
/// deviations in 97 and 100 % of white ones, of 4 and 8 in 70 and 100 % with a memory of a
/// fiftieth. Tested: test_equilibration_drift.
static inline bool equilibration_drifts(const struct equilibration_drift *drift, size_t count) {
    return count > 0 && drift->evidence > 3 + log10((double)count);
}

/// Whether the samples of a simulation are those of equilibrium, and enough to estimate their own
/// error, by two tests.
///
/// - They do not drift, by mf_equilibration_drift.
/// - Ten of them are independent, by mf_statistics_inefficiency, where there are 50 to tell.
///   With fewer, errors are too small, and a slow drift looks like a correlation.
///
/// Of series of n Gaussian samples with a memory of exp(−t/t_0) that are in equilibrium, with 40
/// independent ones at least, it complains of less than 0.5 %; with 2 independent ones of more than
/// 90 %. A series whose scatter is within rounding is in order.
///
/// Fails: UNCONVERGED with both parts, or the number of independent samples, in the message, also
/// of fewer than EQUILIBRATION_MIN_SAMPLES; NO_MEMORY. Tested: test_equilibrium.
/// @param[in] name  "potential energy", for the message
/// @param[in] unit  of it, reduced
/// @param[in] series  shape [samples]
enum status mf_equilibration_check(const char *name, const char *unit, const double *series,
                                   size_t samples) MUST_USE;
