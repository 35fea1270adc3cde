// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The friction weight that other engines have, A (1 − r/r_c)^s, nearest to a given one.
#pragma once

#include "export/export_model.h"

struct export_power {
    double amplitude; ///< A [sqrt(μ/τ)]
    double exponent;  ///< s
    double cutoff;    ///< r_c [λ]
    double misfit; ///< sqrt(Σ w (ω − A (1 − r/r_c)^s)² / Σ w ω²), w = r² exp(−Φ/k_B T)
};

/// A misfit below which the two count as the same friction: dynamics differ by less than they can
/// be measured in a run of some minutes.
#define EXPORT_POWER_BOUND 0.01

/// Least squares of a pair type's ω, weighted as pairs of a dilute gas are; s = 1, which engines
/// know best, if it is good enough, or if `only_linear`, whatever it leaves. All zero where ω is.
/// Tested: test_export_model.
struct export_power mf_export_power_fit(const struct table *omega, const struct table *potential,
                                        int pair, double temperature, bool only_linear);
