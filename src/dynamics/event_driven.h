// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Hard discs and spheres as an integrator: what others may know of its state.
#pragma once

#include "dynamics/hard_gas.h"
#include "dynamics/simulation.h"

struct event_driven_parameters {
    int walls; ///< bit d: axis d has reflecting walls
};

/// What a simulation with this integrator keeps.
struct event_driven {
    struct hard_gas gas;
    double virial;  ///< its sum at the end of the last step, which may have been interrupted since
    double seconds; ///< spent on events, by this process
    uint64_t collisions; ///< in them
};

/// The state of a simulation; NULL with another integrator.
const struct event_driven *mf_event_driven_state(const struct simulation *simulation);
