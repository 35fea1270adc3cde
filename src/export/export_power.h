// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The friction weights that other engines have, and which of them is nearest to a given ω.
#pragma once

#include "curves/table.h"

/// What friction between pairs an engine has: none; ω = A (1 − r/r_c); A (1 − r/r_c)^s, as LAMMPS's
/// dpd/ext/tstat; A (1 − (r/r_c)^s), as ESPResSo.
enum export_friction { EXPORT_NO_FRICTION, EXPORT_LINEAR, EXPORT_POWER, EXPORT_RISING };

struct export_power {
    enum export_friction family;
    double amplitude; ///< A [sqrt(μ/τ)]
    double exponent;  ///< s
    double cutoff;    ///< r_c [λ]
    double misfit;    ///< sqrt(Σ w (ω − law)² / Σ w ω²), w = r² exp(−Φ/k_B T)
};

/// A misfit below which the two count as the same friction: dynamics differ by less than they can
/// be measured in a run of some minutes.
#define EXPORT_POWER_BOUND 0.01

/// Least squares of a pair type's ω, weighted as pairs of a dilute gas are; s = 1, which engines
/// know best, if it is good enough. All zero where ω is.
/// @param[in] form  the family; an exponent and a cutoff, 0: to be found, and that of ω
/// Tested: test_export_model.
struct export_power mf_export_power_fit(const struct table *omega, const struct table *potential,
                                        int pair, double temperature,
                                        const struct export_power *form);

/// Tables of such laws, one for each pair type. Fails: NO_MEMORY.
enum status mf_export_power_table(const struct export_power *power, int pairs,
                                  struct table *omega) MUST_USE;
