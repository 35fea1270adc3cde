// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The linear step of inverse Monte Carlo.
#pragma once

#include "base/status.h"

#include <gsl/gsl_matrix.h>
#include <stdbool.h>
#include <stddef.h>

/// What a curve of x is, for the prior.
struct imc_shape {
    /// 0: of pairs, which ends at 0 half a spacing beyond its last bin. Else its ends are free, and
    /// it may bend by k_B T within so many bins.
    double bend;
    bool periodic; ///< it has no ends
};

/// ⟨S⟩ responds to the potential as ∂⟨S_a⟩/∂Φ_b = −C_ab / k_B T, C the covariance of S.
/// A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 (1995), eq. 8.
struct imc_system {
    size_t size;
    const size_t *block;           ///< sizes of the curves that x is made of, shape [blocks]
    size_t blocks;                 ///< 0: x is one curve
    const struct imc_shape *shape; ///< of each block; NULL: all are of pairs
    const double *covariance;      ///< C, shape [size, size], row-major
    const double *excess;          ///< ⟨S⟩ − S*, shape [size]
    const double *variance;        ///< of the excess by statistics alone, shape [size], > 0
    const double *noise;      ///< L of the covariance V = L Lᵀ of the excess, lower triangle,
                              ///< shape [size, size]; NULL: the variances are all
    const double *steepness;  ///< of curves of pairs: by how many k_B T the reference changes
                              ///< within ℓ, shape [size]; NULL: 0
    double temperature;       ///< [k_B T_0]
    double spacing;           ///< of the bins [λ]
    const double *constraint; ///< p, shape [size]: x is to meet p·x = wanted exactly; or NULL
    double wanted;
    const double *phi; ///< what x is added to, shape [size]: where `strength` is given, the prior
                       ///< is that of phi + x − reference; NULL: of x
    const double *reference; ///< shape [size]
};

struct imc_solution {
    double strength;   ///< of the regularisation
    double misfit;     ///< χ² of the predicted excess, by bin: 1 means as good as the statistics
    double directions; ///< of the excess that x follows, out of `size`: trace of the hat matrix
};

/// Change of the potential that removes the excess as far as it is more than noise:
///   minimise  |L⁻¹ (excess − C x/k_B T)|² + α (|Dx|² + ρ|x|²)
/// (Tikhonov) with the covariance V = L Lᵀ of the excess, with D and ρ of mf_imc_solve_prior,
/// subject to the constraint if there is one. The strength α is the largest whose predicted excess
/// is within the noise, χ² = size (discrepancy principle: V. A. Morozov, Soviet Math. Dokl. 7, 414
/// (1966)), unless `strength` > 0 gives it. Excess that no x removes, as where C is singular, is
/// left: then χ² is what remains at the weakest strength, and half the size. Differs from the
/// paper, which solves C x = k_B T · excess as it stands: C has directions that the sampling does
/// not determine, and their noise would be amplified into the potential.
/// @param[out] x  shape [size] [k_B T_0]
/// Fails: NO_MEMORY. Tested: test_imc_solve, and against VOTCA's answers test_imc_solve_votca.
enum status mf_imc_solve(const struct imc_system *system, double strength, double *x,
                         struct imc_solution *solution) MUST_USE;

/// The whitened equations: B = L⁻¹ C/k_B T, shape [size, size], and L⁻¹ excess, shape [size],
/// or NULL. Fails: NO_MEMORY.
enum status mf_imc_solve_rows(const struct imc_system *system, gsl_matrix *response,
                              gsl_vector *excess) MUST_USE;

/// What the rows of the prior, as below, still ask of x: −D (phi − reference), that of the last
/// difference of a curve of pairs −D phi, as the curve ends at 0 whatever the reference does.
/// @param[out] excess  shape [2 size − 1]
/// Fails: NO_MEMORY. Tested: test_imc_solve_blocks.
enum status mf_imc_solve_prior_excess(const struct imc_system *system, const gsl_matrix *rows,
                                      gsl_vector *excess) MUST_USE;

/// Distance ℓ over which a curve of pairs may bend by k_B T, or by as much as the reference changes
/// there [λ]: features of liquids are wider, and a repulsion of many k_B T bends as it rises.
extern const double mf_imc_smooth_length;

/// Rows of the smoothness prior in `rows`, shape [2 size − 1, size]: D, the second difference over
/// ℓ in 1 + steepness, or over the bins of a shape, and sqrt(ρ). A curve of pairs ends at 0 half a
/// spacing beyond its last bin, at the cutoff, so that D of the ramp 1 − r/r_c is 0 and the ramp is
/// free but for ρ; below its first bin it is free: no row reaches there. Each of several curves has
/// its own. Where a step that knows nothing of the cutoff has left a jump there, smooth steps would
/// keep it: the last difference is that of phi + x. Of the system `size`, `spacing`, blocks and
/// shapes are read.
void mf_imc_solve_prior(const struct imc_system *system, gsl_matrix *rows);
