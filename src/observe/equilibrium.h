// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whether the samples of a simulation are those of equilibrium, and enough to estimate their
/// own error.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Check a series by two tests.
///
/// - Its halves agree: their means differ by at most four standard errors, each half's own.
/// - It has ten independent samples, by mf_statistics_inefficiency, where it has 50 samples to
/// tell.
///   With fewer, errors are too small, and a slow drift looks like a correlation.
///
/// Of series of n Gaussian samples with a memory of exp(−t/t_0) that are in equilibrium, with 40
/// independent ones at least, it complains of less than 1.5 %, with 100 of less than 0.1 %; with 2
/// independent ones of more than 90 %. A series whose scatter is within rounding is in order, as
/// are fewer than 20 samples.
///
/// Fails: UNCONVERGED with both halves, or the number of independent samples, in the message,
/// NO_MEMORY. Tested: test_equilibrium.
/// @param[in] name  "potential energy", for the message
/// @param[in] series  shape [samples]
enum status mf_equilibrium_check(const char *name, const double *series, size_t samples) MUST_USE;
