// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Are two vectors of correlated means equal within their errors? With an exact rate of false
/// alarms. Tested: test_hotelling.
#pragma once

#include "base/comoments.h"

/// Probability that independent normal samples scatter so far from `mean`, or farther.
///   T² = n (x̄ − μ)ᵀ S⁻¹ (x̄ − μ),  T² (n − p) / (p (n − 1)) ~ F(p, n − p)
/// H. Hotelling, Ann. Math. Stat. 2, 360 (1931). A χ² over bins whose correlations are unknown and
/// are estimated by S from the same n samples: n must exceed p.
double hotelling_one_sample(const struct comoments *samples, const double *mean);

/// The same for the difference of two means with one covariance matrix.
///   T² = n m/(n + m) (x̄ − ȳ)ᵀ S⁻¹ (x̄ − ȳ),
///   T² (n + m − p − 1) / (p (n + m − 2)) ~ F(p, n + m − p − 1)
double hotelling_two_samples(const struct comoments *first, const struct comoments *second);
