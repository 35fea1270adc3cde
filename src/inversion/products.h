// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Products of matrices, in the cache, with the bits of GSL, which goes through a whole
/// matrix for each row of the other.
#pragma once

#include "base/status.h"

#include <gsl/gsl_matrix.h>

/// The lower triangle of C ← α AᵀA + β C, as gsl_blas_dsyrk, which goes down columns: of 700 rows
/// and columns 0.03 s, not 0.2; of the 1400 nearly empty rows of a prior 0.002, not 0.4.
/// @param[in]     a  shape [m, n]
/// @param[in,out] c  shape [n, n]
/// Fails: NO_MEMORY. Tested: test_products.
enum status mf_products_gram(double alpha, const gsl_matrix *a, double beta,
                             gsl_matrix *c) MUST_USE;

/// C ← A B, as gsl_blas_dgemm.
/// @param[in]  a, b  shapes [l, m], [m, n]
/// @param[out] c     shape [l, n]
/// Fails: NO_MEMORY. Tested: test_products.
enum status mf_products_find(const gsl_matrix *a, const gsl_matrix *b, gsl_matrix *c) MUST_USE;

/// C ← A B of a symmetric A, of which the lower triangle is read, as gsl_blas_dsymm.
/// @param[in,out] a  shape [n, n]; afterwards its upper triangle is the lower one
/// @param[in]     b  shape [n, m]
/// @param[out]    c  shape [n, m]
/// Fails: NO_MEMORY. Tested: test_products.
enum status mf_products_symmetric(gsl_matrix *a, const gsl_matrix *b, gsl_matrix *c) MUST_USE;
