// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The few largest eigenvalues of a covariance matrix.
#pragma once

#include "base/status.h"

#include <gsl/gsl_matrix.h>
#include <gsl/gsl_vector.h>

/// The largest eigenvalues λ of a positive matrix, largest first, and their eigenvectors of length
/// 1. All of them, by gsl_eigen_symmv, took a third of an inversion's algebra at 1900 rows.
/// @param[in]  matrix   shape [n, n], symmetric
/// @param[out] values   shape [k], k ≤ n
/// @param[out] vectors  shape [n, k]
/// Accurate to 1e-10 of λ where the next ones are well below it. Fails: NO_MEMORY.
/// Tested: test_principal.
enum status mf_principal_find(const gsl_matrix *matrix, gsl_vector *values,
                              gsl_matrix *vectors) MUST_USE;
