// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Parameters of the integrators brownian and euler-maruyama, and what free particles do.
#pragma once

struct simulation_setup;

struct brownian_parameters {
    double friction;                ///< γ of each particle with what is at rest [μ/τ]
    double orientation_friction;    ///< γ_r, of its turning [μ λ²/τ]
    double orientation_temperature; ///< T_r, of its turning [k_B T_0]
};

/// A particle alone, which nothing turns:
///   ⟨n(t)·n(0)⟩ = exp(−D_r t),
///   MSD = 4 D_t t + 2 v_0² [t/D_r − (1 − exp(−D_r t))/D_r²],   D = D_t + v_0²/(2 D_r).
/// B. ten Hagen, S. van Teeffelen and H. Löwen, J. Phys.: Condens. Matter 23, 194119 (2011).
struct brownian_free {
    double diffusion;             ///< D_t = T/γ [λ²/τ]
    double speed;                 ///< v_0 = α/γ [λ/τ]
    double orientation_diffusion; ///< D_r = T_r/γ_r [1/τ]
};

/// Numbers of a scene that one of these integrators moves. Fails: never. Tested: test_active.
struct brownian_free mf_brownian_free(const struct simulation_setup *setup);

/// The MSD at a time [λ²].
double mf_brownian_free_msd(const struct brownian_free *free, double time);

/// D, which the slope of the MSD comes to [λ²/τ].
double mf_brownian_free_long_time(const struct brownian_free *free);
