// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The bath of each bead that other engines have: BAOAB, B. Leimkuhler and C. Matthews, Appl.
/// Math. Res. Express 2013, 34 (2013). No scene names it: an export is compared with it.
#pragma once

#include "dynamics/integrator.h"

struct langevin_parameters {
    double rate; ///< γ/m of each particle with what is at rest [1/τ]
};

/// Tested: test_langevin.
extern const struct integrator mf_langevin;
