// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A force that drives a flow of known shape, whose height tells the viscosity.
///
/// The acceleration of each particle along x is A cos(kz), k = 2π/L_z, less its mean over all
/// particles, so that momentum is conserved. In the steady flow v_x = V cos(kz) the force
/// on a slice is what friction with its neighbours takes, ρ A = η k² V: B. Hess, J. Chem. Phys.
/// 116, 209 (2002). η is that of the wave number k; the gradient kV of the flow must be slow
/// against what the particles do by themselves.
#pragma once

#include "forces/interaction.h"

struct shear_wave_parameters {
    double acceleration; ///< A [λ/τ²]
};

/// k [1/λ] of a box.
static inline double shear_wave_number(const struct box *box) {
    return 2 * M_PI / box->length[2];
}

/// The wave among the interactions of a scene, or NULL.
const struct shear_wave_parameters *
mf_shear_wave_find(const struct interaction_choice *interactions, int count);
