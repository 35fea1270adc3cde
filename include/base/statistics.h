// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Means with standard errors, updated without cancellation.
#pragma once

/// Running mean and sum of squared deviations of one number.
/// B. P. Welford, Technometrics 4, 419 (1962).
struct running_mean {
    double count, mean, squares;
};

void statistics_add(struct running_mean *running, double value);

/// Standard error of the mean if the values are independent; 0 for fewer than two.
double statistics_standard_error(const struct running_mean *running);
