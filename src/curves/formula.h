// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Closed formulas for Φ(r) and ω(r).
#pragma once

#include "curves/curve.h"

/// Φ = 4ε[(σ/r)¹² − (σ/r)⁶], shifted to 0 at the cutoff. Below σ/2 it goes on as a straight line
/// with its slope there, so that an overlap gives a finite (and enormous) force.
/// J. E. Lennard-Jones, Proc. R. Soc. A 106, 463 (1924).
extern const struct curve_family mf_formula_lennard_jones;

/// Φ = ½ a r_c (1 − r/r_c)², that is, the force a(1 − r/r_c).
/// R. D. Groot and P. B. Warren, J. Chem. Phys. 107, 4423 (1997), eq. 5.
extern const struct curve_family mf_formula_soft_repulsion;

/// Φ = ε exp(−(r/σ)²), shifted to 0 at the cutoff.
/// F. H. Stillinger, J. Chem. Phys. 65, 3968 (1976).
extern const struct curve_family mf_formula_gaussian;

/// ω = σ(1 − r/r_c)^s for r_0 < r ≤ r_c, else 0. ω² is the friction: in the notation of Groot and
/// Warren γ w_D = ω², so γ = 4.5 is σ = sqrt(4.5) here.
extern const struct curve_family mf_formula_power_omega;

struct formula_lennard_jones_parameters {
    double epsilon, sigma, cutoff;
};

struct formula_soft_repulsion_parameters {
    double a, cutoff;
};

struct formula_gaussian_parameters {
    double epsilon, sigma, cutoff;
};

struct formula_power_omega_parameters {
    double sigma, exponent, inner_cutoff, cutoff;
};
