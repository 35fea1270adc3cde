// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The flow of the solvent along x over y, the viscosity that it tells, and its temperature.
///
/// What drives it says which curve is fitted, v = A + B s(y), by least squares over the bins, each
/// with the number of its particles and s averaged over it:
///   plates and an acceleration g:    s = g y (H − y)/2, B = 1/ν, and A the slip at the plates;
///   a wave of acceleration in a box: s = a sin(k y)/k², k = 2π/L, B = 1/ν.
/// Errors are those of blocks of time. Tested: physics/test_collision_dynamics.
#pragma once

#include "observe/observable.h"

struct flow_profile_summary {
    double viscosity, viscosity_error; ///< kinematic [λ²/τ]; NaN if nothing drives the flow
    double slip, slip_error;           ///< A in units of the highest velocity that s and B make
    /// D of the beads along y and z, without plates, from their ways over blocks of time [λ²/τ],
    /// and the viscosity over it; NaN without beads.
    double diffusion, diffusion_error, schmidt, schmidt_error;
    /// Of the solvent, relative to the mean velocity of each bin [k_B T_0].
    double temperature, temperature_error;
};

extern const struct observable mf_flow_profile;

/// From a state of mf_flow_profile.
struct flow_profile_summary mf_flow_profile_result(const void *state);
