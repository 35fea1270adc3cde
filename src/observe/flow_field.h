// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The flow of the solvent in the plane of x and y, and the drag on the obstacle: the
/// momentum that bounces and virtual particles give it, over time.
///
/// In three dimensions the plane is a slice, as thick as a bin, through the obstacle's centre.
/// Tested: physics/test_collision_dynamics_flow.
#pragma once

#include "observe/observable.h"

struct flow_field_summary {
    double velocity, velocity_error; ///< U, mean along x of the fluid                [λ/τ]
    double drag, drag_error;         ///< F, along x, on the obstacle                 [k_B T_0/λ]
    double driving_force;            ///< of the acceleration, on the whole solvent   [k_B T_0/λ]
    double coefficient;              ///< F/(½ ρ U² A), A = 2R, or πR² of a sphere
    double reynolds;                 ///< 2R U/ν, with the viscosity of theory
};

extern const struct observable mf_flow_field;

/// From a state of mf_flow_field.
struct flow_field_summary mf_flow_field_result(const void *state);
