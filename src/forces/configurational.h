// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The configurational temperature, fast enough to be looked at in every sample.
#pragma once

#include "forces/reference_forces.h"

/// As mf_reference_configurational, in double precision, with sums in another order. Fails:
/// NO_MEMORY. Tested: test_configurational, which has that one for its slow twin.
enum status mf_configurational(const struct table *potential, const struct composition *composition,
                               double temperature, const struct particles *particles,
                               const struct neighbours *neighbours, double *const *known,
                               double *const *others, double *squares, double *laplacian) MUST_USE;
