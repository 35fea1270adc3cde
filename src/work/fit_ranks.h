// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the ranks of a fit (base/ranks.h) must have in common.
#pragma once

#include "defaults/fit_file.h"
#include "problem/unknowns.h"

/// Digest of what was read and of how this processor computes: ranks that differ here would keep
/// different states. The C library takes other instructions for exp and its like on processors of
/// another kind, and so do the kernels.
uint64_t mf_fit_ranks_digest(const struct fit_file *fit);

/// Digest of the curves after an iteration.
/// @param[in] curve  shape [UNKNOWNS][mf_unknowns_points]
uint64_t mf_fit_ranks_digest_curves(const struct unknowns *unknowns, double *const *curve);
