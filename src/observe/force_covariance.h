// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The friction weight, seen in the forces: covariance of the forces on two particles.
///
/// The random forces on the particles of a pair are opposite and grow as Δt^(−1/2), so that for a
/// small time step they are what is left of the covariance of the total forces F (conservative,
/// friction and noise) of pairs at distance r:
///   κ(r) = −Δt ⟨F_i · F_j⟩ → 2 k_B T ω(r)².
/// What does not grow with 1/Δt drops out between two time steps (Richardson's extrapolation):
///   2 k_B T ω² ≈ Δt_1 Δt_2/(Δt_1 − Δt_2) (⟨F_i · F_j⟩_1 − ⟨F_i · F_j⟩_2)
///             = (Δt_2 κ_1 − Δt_1 κ_2)/(Δt_2 − Δt_1).
/// A. Eriksson, M. N. Jacobi, J. Nyström and K. Tunstrøm, Phys. Rev. E 77, 016707 (2008).
/// The error is of order Δt_1 Δt_2, and with a potential the factor is large where it is steep (the
/// friction of dpd-verlet sees velocities of half a step before): measured for the fluid of Groot
/// and Warren at r = 0.35, −11(2) % at Δt = 0.025 and 0.05, −0.8(5) % at 0.005 and 0.01; without a
/// potential, −1 % at 0.025 and 0.05.
///
/// F is the force at the sample: of an integrator that sums friction and noise as forces
/// (dpd-verlet). Those that split them off draw kicks that are no force at any one time, and Δv/Δt
/// of a step would be damped by their own, different, functions of ω² Δt: they are refused.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "dynamics/simulation.h"
#include "observe/sample_blocks.h"

struct force_covariance_plan {
    double range; ///< 0: the cutoff of ω [λ]
    int64_t bins;
};

struct force_covariance {
    double width; ///< of a bin [λ]
    size_t bins;
    double time_step;
    struct sample_blocks blocks; ///< of Σ F_i · F_j in each bin [(k_B T_0/λ)²], then of pairs
};

/// Prepare for `planned` samples.
/// Fails: BAD_INPUT if the simulation has no ω, if its integrator does not take friction as a
/// force, or if the range exceeds that of the forces; NO_MEMORY.
enum status mf_force_covariance_init(struct force_covariance *covariance,
                                     const struct force_covariance_plan *plan,
                                     const struct simulation *simulation, size_t planned) MUST_USE;
void mf_force_covariance_clear(struct force_covariance *covariance);

/// Add the pairs of the present configuration, the forces being those of its step.
void mf_force_covariance_sample(struct force_covariance *covariance,
                                const struct simulation *simulation);

/// κ and its standard error, by jackknife over blocks of consecutive samples.
/// @param[out] kappa, error  shape [bins]; NaN without pairs; [(k_B T_0)² τ/λ² = k_B T_0 μ/τ]
/// Tested: test_force_covariance (unit, physics).
void mf_force_covariance_result(const struct force_covariance *covariance, double *kappa,
                                double *error);
