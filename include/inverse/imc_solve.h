// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The linear step of inverse Monte Carlo.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// ⟨S⟩ responds to the potential as ∂⟨S_a⟩/∂Φ_b = −C_ab / k_B T, C the covariance of S.
/// A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 (1995), eq. 8.
struct imc_system {
    size_t size;
    const double *covariance; ///< C, shape [size, size], row-major
    const double *excess;     ///< ⟨S⟩ − S*, shape [size]
    const double *variance;   ///< of the excess by statistics alone, shape [size], > 0
    double temperature;       ///< [k_B T_0]
    double spacing;           ///< of the bins [λ]
};

struct imc_solution {
    double strength; ///< α of the regularisation
    double misfit;   ///< χ² of the predicted excess, by bin: 1 means as good as the statistics
};

/// Change of the potential that removes the excess as far as it is more than noise:
///   minimise  Σ_a (excess_a − Σ_b C_ab x_b / k_B T)² / variance_a + α (|Dx|² + ρ|x|²)
/// (Tikhonov) with D the second difference over a tenth of λ and x = 0 beyond the last bin. The
/// strength α is the largest whose predicted excess is within the noise, χ² = size (discrepancy
/// principle: V. A. Morozov, Soviet Math. Dokl. 7, 414 (1966)), unless `strength` > 0 gives it.
/// Excess that no x removes, as where C is singular, is left: then χ² is what remains at the
/// weakest strength, and half the size. Differs from the paper, which solves C x = k_B T · excess
/// as it stands: C has directions that the sampling does not determine, and their noise would be
/// amplified into the potential.
/// @param[out] x        shape [size] [k_B T_0]
/// @param[out] x_error  standard error of x by the noise of the excess, shape [size], or NULL
/// Fails: NO_MEMORY. Tested: test_imc_solve.
enum status imc_solve(const struct imc_system *system, double strength, double *x, double *x_error,
                      struct imc_solution *solution) MUST_USE;

/// The step as VOTCA's csg_imc_solve takes it, for those who come from there:
///   x = −k_B T (AᵀA + λ)⁻¹ Aᵀ · excess,   A = −C (VOTCA's .gmc), excess (its .imc), λ =
///   `strength`,
/// where eigenvalues of AᵀA + λ below 1e-12 are left out. The unit of λ is that of S⁴: what is
/// right depends on the number of particles. Interactions of several kinds are blocks of one C. D.
/// Rosenberger, M. Hanke and N. F. A. van der Vegt, Eur. Phys. J. Spec. Top. 225, 1323 (2016).
/// Parameters and failures as imc_solve; `spacing` is not read. Tested: test_imc_votca.
enum status imc_votca(const struct imc_system *system, double strength, double *x, double *x_error,
                      struct imc_solution *solution) MUST_USE;
