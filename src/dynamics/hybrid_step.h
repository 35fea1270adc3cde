// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The time step with which a hybrid Monte Carlo begins to tune its own.
#pragma once

#include "curves/table.h"
#include "forces/molecules.h"

struct hybrid_step {
    double first, longest; ///< [τ]
    int64_t inner;         ///< steps of bonds, angles and dihedrals in one of the pairs
};

/// By the fastest pairs and the fastest terms of molecules of mass 1. Either may be NULL. Tested:
/// test_hybrid.
struct hybrid_step mf_hybrid_step_find(const struct table *potential,
                                       const struct molecules *molecules, double temperature);
