// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Parameters of the integrator dpd-verlet.
#pragma once

struct dpd_verlet_parameters {
    double lambda; ///< how far velocities are predicted for the friction, in time steps
};
