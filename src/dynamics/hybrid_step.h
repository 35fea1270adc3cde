// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The time step with which a hybrid Monte Carlo begins to tune its own.
#pragma once

#include "curves/table.h"
#include "dynamics/integrator.h"
#include "forces/many_body.h"
#include "forces/molecules.h"

struct hybrid_step {
    double first, longest; ///< [τ]
    int64_t inner;         ///< steps of bonds, angles and dihedrals in one of the pairs
};

/// Variance of q [λ²] or [rad²] by the law of a group: the square of half the width of its well at
/// k_B T/2.
double mf_hybrid_step_variance(const struct bonded_curve *curve, int order, double temperature);

/// ω² of a group whose q has this variance, in molecules of mass 1 whose shortest bond has the
/// length [λ]: with U'' = k_B T/variance of a bond 2 U'', of others 6 U''/length², which is that of
/// a straight angle and more than that of others.
double mf_hybrid_step_squared_frequency(int order, double variance, double length,
                                        double temperature);

/// The share of (Ω Δt)² by which an integrator makes the variance of a stiff bond wrong: a quarter
/// for Verlet's kind (of harmonic bonds, exactly). Of aboba it was 0.015 in a melt of harmonic
/// bonds and angles; the U of fits has narrower bends, and 0.1 is reckoned with
/// (lab/molecules.md).
double mf_hybrid_step_wrong(const struct integrator *integrator);

/// ω² of the fastest group that has a law, of molecules of mass 1 [1/τ²]; 0: of none.
double mf_hybrid_step_fastest(const struct molecules *molecules, double temperature);

/// By the fastest pairs and the fastest terms of molecules of mass 1, those of tables with noise by
/// their curvature; without pairs, by the range of local densities. Each may be NULL. Tested:
/// test_hybrid.
struct hybrid_step mf_hybrid_step_find(const struct table *potential,
                                       const struct molecules *molecules,
                                       const struct many_body *many_body, double temperature);
