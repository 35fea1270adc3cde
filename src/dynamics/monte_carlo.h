// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Metropolis Monte Carlo as an integrator: a step is a sweep, and there is no time.
///
/// What moves is a chain of its own (dynamics/metropolis.h), with the full list that single moves
/// want; the simulation's particles follow it after each sweep, for whoever looks at them.
#pragma once

#include "dynamics/metropolis.h"

/// What a simulation with this integrator keeps.
struct monte_carlo {
    struct metropolis chain;
    bool settled; ///< the sizes of moves are fixed, as detailed balance asks
};
