// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a fit changed: its curves after the first iteration, which measured the start, and
/// now.
#pragma once

#include "problem/unknowns.h"

/// Of one curve, over the points that the data determine.
struct fit_change {
    double rms;           ///< of the difference, in the unknown's unit
    double well, well_at; ///< the lowest point of a potential [k_B T_0] [λ]
    double first_well, first_well_at;
};

/// @param[in] first, last  of all curves of the unknown, shape [mf_unknowns_points]
/// Tested: test_fit_change.
struct fit_change mf_fit_change_find(const struct unknowns *unknowns, enum unknown_kind kind,
                                     size_t curve, const double *first, const double *last);
