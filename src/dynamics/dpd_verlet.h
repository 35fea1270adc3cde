// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Parameters of the integrator dpd-verlet.
#pragma once

#include <stdint.h>

struct dpd_verlet_parameters {
    double lambda;       ///< how far velocities are predicted for the friction, in time steps
    int64_t inner_steps; ///< of the forces beside the pairs (dynamics/respa.h)
};
