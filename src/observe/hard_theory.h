// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is known of hard discs and spheres in equilibrium.
///
/// η is the share of the volume that they fill, χ their pair distribution where two touch, and
/// Z = 1 + 2^(d − 1) η χ of one component:
///   discs    χ = (1 − 7η/16)/(1 − η)² − (η³/128)/(1 − η)⁴,
///   spheres  χ = (1 − η/2 + η²/12 − η³/6)/(1 − η)³.
/// The first term is that of D. Henderson, Mol. Phys. 30, 971 (1975), whose Z is 0.05 % too large
/// at η = 0.3 and 0.45 % at 0.5, by the virial series; with the second, of S. Luding, Phys. Rev. E
/// 63, 042201 (2001), it is within 0.1 %. Spheres: N. F. Carnahan and K. E. Starling, J. Chem.
/// Phys. 51, 635 (1969), without the last two terms, whose Z is 0.26 % too small at η = 0.3; with
/// them, of J. Kolafa (in T. Boublík and I. Nezbeda, Collect. Czech. Chem. Commun. 51, 2301
/// (1986)), within 0.05 %. Mixtures with diameters σ, τ = σ_i σ_j/(σ_i + σ_j):
///   discs    χ_ij = 1/(1 − η) + (χ − 1/(1 − η)) 2τ ⟨σ⟩/⟨σ²⟩,
///            Z = (1 − s)/(1 − η) + s Z_1, s = ⟨σ⟩²/⟨σ²⟩
///            (A. Santos, S. B. Yuste and M. López de Haro, Mol. Phys. 96, 1 (1999))
///   spheres  χ_ij = 1/(1 − η) + 3 ξ τ/(1 − η)² + 2 (ξ τ)²/(1 − η)³,
///            Z = 1/(1 − η) + 3 ξ_1 ξ/(ξ_0 (1 − η)²) + ξ³ (3 − η)/(ξ_0 (1 − η)³),
///            ξ_n = (π/6) ρ ⟨σⁿ⟩, ξ = ξ_2 (G. A. Mansoori et al., J. Chem. Phys. 54, 1523 (1971)),
///            and Kolafa's terms as the last of these, times (2τ ⟨σ²⟩/⟨σ³⟩)² and ⟨σ²⟩³/⟨σ³⟩².
/// A particle i meets, of the density ρ_j,
///   discs    ρ_j σ_ij χ_ij sqrt(2π k_B T/μ_ij),     spheres  ρ_j σ_ij² χ_ij sqrt(8π k_B T/μ_ij)
/// a time, with σ_ij = (σ_i + σ_j)/2 and the reduced mass μ_ij.
/// Tested: test_hard_theory (unit), test_kinetic_gas (physics).
#pragma once

#include <stddef.h>

/// Particles that are alike.
struct hard_theory_species {
    double radius, mass, count;
};

/// At most so many are distinguished; the rates of more are not known.
enum { HARD_THEORY_MAX_SPECIES = 16 };

struct hard_theory {
    double eta;
    double compressibility_factor; ///< Z = p V/(N k_B T)
    double collision_rate;         ///< of a particle, the mean of all [1/τ]; NaN: not known
    double mean_free_path;         ///< mean speed over that           [λ]; NaN: not known
};

/// @param[in] radius, mass  shape [count] each
struct hard_theory mf_hard_theory(int dimensions, double volume, double temperature,
                                  const double *radius, const double *mass, size_t count);
