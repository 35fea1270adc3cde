// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A simulation that goes on with another temperature or time step.
#pragma once

#include "dynamics/simulation.h"

struct simulation_change {
    uint64_t step;      ///< after which it holds
    double temperature; ///< from then on [k_B T_0]
    double time_step;   ///< from then on [τ]
};

/// Whether a simulation can go on so; nothing changes. Fails: BAD_INPUT, naming what cannot change:
/// a value out of its range, dynamics that are made of it (hard particles, a solvent's), a
/// temperature that nothing holds.
enum status mf_simulation_check_change(const struct simulation *simulation,
                                       const struct simulation_change *change) MUST_USE;

/// Go on so from the next step on. Friction, noise and memory are rebuilt; velocities, and what
/// pairs remember, are scaled by sqrt(T'/T), which turns one stationary law into the other. The
/// skin of the neighbour list stays, and so does the order of sums that follows from it.
/// Fails: as mf_simulation_check_change; NO_MEMORY. Tested: test_simulation_change.
enum status mf_simulation_change(struct simulation *simulation,
                                 const struct simulation_change *change) MUST_USE;

/// Another box for the particles where they are, as frames of constant pressure have it; that of
/// the setup stays. The forces are those of before. Fails: BAD_INPUT for a box below twice the
/// cutoff, as mf_neighbours_init; NO_MEMORY. Tested: test_simulation_box.
enum status mf_simulation_set_box(struct simulation *simulation, const struct box *box) MUST_USE;
