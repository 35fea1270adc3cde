// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Products of a matrix with its own transpose.
#pragma once

#include "base/status.h"

#include <gsl/gsl_matrix.h>

/// The lower triangle of C ← α AᵀA + β C, with the bits of gsl_blas_dsyrk, which goes down columns:
/// of 700 rows and columns 0.03 s, not 0.2; of the 1400 nearly empty rows of a prior 0.002, not
/// 0.4.
/// @param[in]     a  shape [m, n]
/// @param[in,out] c  shape [n, n]
/// Fails: NO_MEMORY. Tested: test_gram.
enum status mf_gram(double alpha, const gsl_matrix *a, double beta, gsl_matrix *c) MUST_USE;
