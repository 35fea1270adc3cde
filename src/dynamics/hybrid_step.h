// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The time step with which a hybrid Monte Carlo begins to tune its own.
#pragma once

#include "curves/table.h"
#include "forces/molecules.h"

struct hybrid_step {
    double first, longest; ///< [τ]
    int64_t inner;         ///< steps of bonds, angles and dihedrals in one of the pairs
};

/// ω² of the fastest oscillation that the law of a group allows in molecules of mass 1, whose
/// shortest bond has the length [λ]: of a bond 2 U'', of others 6 U''/length², which is that of a
/// straight angle and more than that of others; U'' by the width of the well at k_B T/2.
double mf_hybrid_step_squared_frequency(const struct bonded_curve *curve, enum topology_order order,
                                        double length, double temperature);

/// By the fastest pairs and the fastest terms of molecules of mass 1. Either may be NULL. Tested:
/// test_hybrid.
struct hybrid_step mf_hybrid_step_find(const struct table *potential,
                                       const struct molecules *molecules, double temperature);
