// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The pressure of an inversion's samples, and how it follows the potential.
#pragma once

#include "base/status.h"

struct inversion;

struct inversion_pressure {
    double value, error; ///< ρ k_B T + ⟨W⟩/(dV) of the samples, and its standard error
    double *slope;       ///< ∂P/∂Φ_b, shape [known]
};

/// Value and error. The error is the scatter of the chains' means, or what that of the samples
/// makes of as many independent ones as g(r) sees, if that is more: few chains may agree by chance.
void inversion_pressure_measure(struct inversion *inversion);

/// Slopes, from how the virial W = −Σ r Φ'(r) over all pairs depends on the potential itself, and
/// on the pairs that it makes:
///   ∂P/∂Φ_b = [⟨∂W/∂Φ_b⟩ − cov(W, S_b)/k_B T]/(dV).
/// Fails: NO_MEMORY. Tested: test_inversion_pressure, against differences of simulations.
enum status inversion_pressure_slopes(struct inversion *inversion) MUST_USE;

/// ∂P/∂A of the ramp A (1 − r/r_c) [1/λ^d].
double inversion_pressure_ramp_slope(const struct inversion *inversion);

/// Add to a step the ramp A (1 − r/r_c) that makes up for the pressure, if the problem asks for
/// one:
///   A = (P* − P) d V / ⟨Σ_pairs r/r_c⟩,
/// in three dimensions (P* − P) · 3 r_c/(2π ρ² ∫ g r³ dr): H. Wang, C. Junghans and K. Kremer, Eur.
/// Phys. J. E 28, 221 (2009), eq. 10. That is the response of the virial with all pairs where they
/// are; they also give way, so that the whole, inversion_pressure_ramp_slope, differs. Used in
/// full: measured for water and a soft fluid, P is at P* after two steps, and "damping" scales all
/// of a step where that is too much. It comes with every step, so that g(r) and P converge
/// together.
void inversion_pressure_add_ramp(const struct inversion *inversion, double *step);
