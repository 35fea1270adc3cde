// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Parameters of the integrator brownian.
#pragma once

struct brownian_parameters {
    double friction; ///< γ of each particle with what is at rest [μ/τ]
};
