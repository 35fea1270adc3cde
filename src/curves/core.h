// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The core of a fitted potential: distances at which the target is 0.
#pragma once

#include <stddef.h>

/// Continue a potential smoothly below the first distance where it is known:
///   Φ(r) = Φ_1 + s d + ½ k d²,  d = r_1 − r ≥ 0,  s = max(0, −Φ'(r_1)).
/// Force continuous at r_1, finite at r = 0, and repulsive enough that no pair gets deep: with
/// k = 2000 k_B T/λ² a step of 0.1 λ inwards costs 10 k_B T, and the oscillation in it is resolved
/// by Δt = 0.01.
/// @param[in]     r          shape [count], growing           [λ]
/// @param[in,out] phi        shape [count]; phi[0 … known − 1] are overwritten  [k_B T_0]
/// @param[in]     known      index of r_1
/// @param[in]     slope      Φ'(r_1)                          [k_B T_0 / λ]
/// @param[in]     stiffness  k                                [k_B T_0 / λ²]
void mf_core_fill(const double *r, double *phi, size_t known, double slope, double stiffness);
