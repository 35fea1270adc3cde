// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Means with standard errors, updated without cancellation.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Running mean and sum of squared deviations of one number.
/// B. P. Welford, Technometrics 4, 419 (1962).
struct running_mean {
    double count, mean, squares;
};

void mf_statistics_add(struct running_mean *running, double value);

/// Standard error of the mean if the values are independent; 0 for fewer than two.
double mf_statistics_standard_error(const struct running_mean *running);

/// How many times the variance of the mean of a stationary series, whose neighbours are correlated,
/// is Γ(0)/n: of several independent series (chains) of the same length, and of several numbers
/// that are measured together and taken to be correlated alike, as the bins of a g(r) are, whose
/// errors then do not scatter as much as if each had its own correlation. 1 for fewer than two
/// values.
///
///   C n/(n − 2W − 1),   C = 1 + 2 Σ_{t=1…W} ρ(t),
///
/// with the mean ρ over all numbers of Γ(t)/Γ(0), the autocovariances about a number's common mean
/// over its n values in all. W ends at the first negative sum of ρ(2k) + ρ(2k+1), which are not
/// allowed to rise: C. J. Geyer, Stat. Sci. 7, 473 (1992), "initial monotone sequence". It is never
/// taken below n/(n − 1), of independent values: what looks like anticorrelation is mostly noise,
/// so that the error of a truly anticorrelated series is too large. The denominator, exact for
/// independent values, makes up for the mean that was taken from them. Costs n (W + 1) of each
/// number.
/// @param[in] values  shape [numbers, chains, length]
/// Tested: test_statistics.
double mf_statistics_inefficiency(const double *values, size_t length, size_t chains,
                                  size_t numbers);

/// Standard error of the mean of one such number; NaN, not known, for fewer than two values:
///   error² = Γ(0)/n times the inefficiency.
///
/// Of more than 64 values it is that of the means of 64 blocks if that is smaller: where values
/// swing, as a pressure does with stiff bonds, their correlation has signs in turn, whose sum ends
/// too early for Geyer, and may be below that of independent values; means over some swings have
/// neither.
/// The truth lies within two errors in 95 % of the series when they are 60 times as long as their
/// correlation, 1 + 2 Σ Γ(t)/Γ(0), in 93 % at 20 times, and in 88 % at 8 times: no estimate can
/// tell what a short series does not show.
/// @param[in] values  shape [chains, length]
/// Tested: test_statistics, test_errors.
double mf_statistics_correlated_error(const double *values, size_t length, size_t chains);

/// Standard errors of the means of several such numbers, of which neighbours are alike, as the bins
/// of a distribution are:
///   error² = Γ(0)/n times the inefficiency,
/// that of all together, which does not scatter as that of each would, but for those that are
/// slower: where five neighbours have more than 1 + 4 sqrt(2/n) times that of all, each has its own
/// if it is larger, and no part in that of the others. A contact that comes and goes slowly would
/// else drown in the many bins that are fast, and its error be a half of what it should be.
///
/// Rms of the means over these errors, of 24 numbers of 20 to 160 values: 0.95 to 1.05 where all
/// are alike; with two to four slow ones 0.87 to 1.08 of these, 0.87 to 0.95 of their neighbours.
/// @param[in]  values  shape [numbers, chains, length]
/// @param[out] error   shape [numbers]; 0 for fewer than two values
/// Tested: test_statistics.
void mf_statistics_correlated_errors(const double *values, size_t length, size_t chains,
                                     size_t numbers, double *error);

/// Of two estimates of the same errors of one curve take that which is larger on the whole, by the
/// mean of the squares' ratio: `others`, or those that are there. Tested: test_statistics.
void mf_statistics_take_larger(double *error, const double *others, size_t count);

/// What is printed as standard errors of one curve: if none is above 0, they are those of a
/// single value, and all become NaN, not known. Tested: test_statistics.
void mf_statistics_mark_unknown_errors(double *error, size_t count);

/// How many independent numbers several of them count as that are measured together, and how well
/// their errors are known.
struct statistics_independence {
    double numbers; ///< n²/Σ ρ_ab², with the correlations ρ of the n numbers that scatter
    double freedom; ///< degrees of freedom of the errors: independent values, less one
};

/// ρ² of two numbers whose correlation r was found by so many independent values, more than two.
/// Few are correlated by chance, and m of them have r² = 1/(m − 1) in the mean where ρ is 0: it is
/// 1 − (1 − r²) (m − 1)/(m − 2), of which a sum over many pairs is right. Tested: test_statistics.
double mf_statistics_square_of_correlation(double square, double independent);

/// By the scatter of their values, with mf_statistics_square_of_correlation. Of fewer than three
/// values all numbers count as one.
/// @param[in] values  shape [numbers, chains, length]
/// Fails: NO_MEMORY. Tested: test_statistics.
enum status mf_statistics_independence(const double *values, size_t length, size_t chains,
                                       size_t numbers,
                                       struct statistics_independence *found) MUST_USE;
