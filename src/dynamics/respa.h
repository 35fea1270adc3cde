// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Velocity Verlet with shorter steps for the forces beside the pairs, as those of bonds.
///
/// The impulses of the pairs act once a step, and between them the others move the particles by
/// steps of their own (reversible reference system propagator: M. Tuckerman, B. J. Berne and G. J.
/// Martyna, J. Chem. Phys. 97, 1990 (1992), eq. 2.20). It is reversible and keeps volumes in phase
/// space, as a proposal of hybrid Monte Carlo must. A step must stay well below half a period of
/// the fastest bond, where the impulses of the pairs resonate with it. Particles of mass 1.
#pragma once

#include "dynamics/integrator.h"

struct respa_parameters {
    int64_t inner; ///< steps of the other forces in one of the pairs, at least 1
};

/// No scene names it.
extern const struct integrator mf_respa;
