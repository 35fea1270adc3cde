// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is known of hard discs and spheres in equilibrium.
///
/// η is the share of the volume that they fill, χ_ij the pair distribution where i and j touch:
///   discs    χ_ij = 1/(1 − η) + (9/8) η ⟨σ⟩/⟨σ²⟩ τ/(1 − η)²,
///            Z = 1/(1 − η) + (⟨σ⟩²/⟨σ²⟩) η (1 + η/8)/(1 − η)²
///   spheres  χ_ij = 1/(1 − η) + 3 ξ τ/(1 − η)² + 2 (ξ τ)²/(1 − η)³,
///            Z = 1/(1 − η) + 3 ξ_1 ξ/(ξ_0 (1 − η)²) + ξ³ (3 − η)/(ξ_0 (1 − η)³)
/// with diameters σ, τ = σ_i σ_j/(σ_i + σ_j), ξ_n = (π/6) ρ ⟨σⁿ⟩, ξ = ξ_2. Of one component they
/// are those of D. Henderson, Mol. Phys. 30, 971 (1975), and N. F. Carnahan and K. E. Starling, J.
/// Chem. Phys. 51, 635 (1969), good to a few parts in a thousand below freezing; of mixtures, of J.
/// T. Jenkins and F. Mancini, J. Appl. Mech. 54, 27 (1987), and G. A. Mansoori et al., J. Chem.
/// Phys. 54, 1523 (1971). A particle i meets, of the density ρ_j,
///   discs    ρ_j σ_ij χ_ij sqrt(2π k_B T/μ_ij),     spheres  ρ_j σ_ij² χ_ij sqrt(8π k_B T/μ_ij)
/// a time, with σ_ij = (σ_i + σ_j)/2 and the reduced mass μ_ij.
/// Tested: test_hard_theory (unit), test_kinetic_gas (physics).
#pragma once

#include <stddef.h>

/// Particles that are alike.
struct hard_theory_species {
    double radius, mass, count;
};

/// At most so many are told apart; the rates of more are not known.
enum { HARD_THEORY_MOST_SPECIES = 16 };

struct hard_theory {
    double eta;
    double compressibility_factor; ///< Z = p V/(N k_B T)
    double collision_rate;         ///< of a particle, the mean of all [1/τ]; NaN: not known
    double mean_free_path;         ///< mean speed over that           [λ]; NaN: not known
};

/// @param[in] radius, mass  shape [count] each
struct hard_theory mf_hard_theory(int dimensions, double volume, double temperature,
                                  const double *radius, const double *mass, size_t count);
