// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How long particles keep their direction, how far it takes them, and how many share one.
///
///   ⟨n_i(s + t) · n_i(s)⟩,   MSD(t) = ⟨|r_i(s + t) − r_i(s)|²⟩,   |⟨n⟩| = |Σ_i n_i|/N,
///
/// n = (cos θ, sin θ). Correlation and MSD are those of observe/motion.h with polarities in the
/// place of velocities: windows, blocks and errors are the same.
#pragma once

#include "dynamics/brownian.h"
#include "observe/motion.h"
#include "observe/sample_series.h"

struct polarity {
    struct motion motion;
    struct sample_series order; ///< |⟨n⟩|
    /// What is known exactly: no interaction but self-propulsion.
    bool noninteracting;
    struct brownian_free free;
};

/// What the MSD tells by its law for a particle alone (dynamics/brownian.h), fitted to all lags
/// with the weight of equal relative errors, and its jackknife error over blocks of time.
struct polarity_fit {
    double speed, speed_error;                                 ///< v_0 [λ/τ]
    double orientation_diffusion, orientation_diffusion_error; ///< D_r [1/τ]
    double effective_diffusion, effective_diffusion_error;     ///< D_t + v_0²/(2 D_r) [λ²/τ]
};

/// NaN before two blocks are complete. Tested: physics/test_active.
struct polarity_fit mf_polarity_fit(const struct polarity *polarity);
