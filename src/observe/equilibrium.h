// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whether the samples of a simulation are those of equilibrium, and enough to estimate their
/// own error.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Check a series by two tests.
///
/// - It does not drift, by mf_equilibration_drift.
/// - It has ten independent samples, by mf_statistics_inefficiency, where it has 50 samples to
/// tell.
///   With fewer, errors are too small, and a slow drift looks like a correlation.
///
/// Of series of n Gaussian samples with a memory of exp(−t/t_0) that are in equilibrium, with 40
/// independent ones at least, it complains of less than 0.5 %; with 2 independent ones of more than
/// 90 %. A series whose scatter is within rounding is in order, as are fewer than 20 samples.
///
/// Fails: UNCONVERGED with both parts, or the number of independent samples, in the message,
/// NO_MEMORY. Tested: test_equilibrium.
/// @param[in] name  "potential energy", for the message
/// @param[in] unit  of it, reduced
/// @param[in] series  shape [samples]
enum status mf_equilibrium_check(const char *name, const char *unit, const double *series,
                                 size_t samples) MUST_USE;
