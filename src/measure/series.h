// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Numbers one after the other, as many as come.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// All zero is none.
struct series {
    double *value; ///< shape [count]
    size_t count, capacity;
};

/// Fails: NO_MEMORY.
enum status mf_series_add(struct series *series, double value) MUST_USE;

void mf_series_clear(struct series *series);

/// NAN of none.
double mf_series_mean(const struct series *series);

/// Its standard error, by mf_statistics_correlated_error; NAN if it is not known.
double mf_series_error(const struct series *series);
