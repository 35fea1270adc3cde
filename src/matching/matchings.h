// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The methods of fits that simulate candidates, or take other methods as their parts, by
/// name.
#pragma once

#include "optimise/optimiser.h"
#include "problem/inverse.h"

/// @param EACH  of a record; EACH_OPTIMISER of (record, name, summary) of each optimiser
#define MATCHINGS(EACH)                                                                            \
    OPTIMISERS(EACH##_OPTIMISER)                                                                   \
    EACH(gauss_newton)                                                                             \
    EACH(pareto)                                                                                   \
    EACH(formulas)                                                                                 \
    EACH(successive)

#define MATCHING_DECLARE(name) extern const struct inverse_method mf_##name;
#define MATCHING_DECLARE_OPTIMISER(record, name, summary)                                          \
    extern const struct inverse_method mf_matching_##record;
MATCHINGS(MATCHING_DECLARE)
#undef MATCHING_DECLARE
#undef MATCHING_DECLARE_OPTIMISER
