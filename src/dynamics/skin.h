// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How wide the neighbour list's skin should be.
#pragma once

#include "system/box.h"

#include <stddef.h>

/// What decides over the skin.
struct skin_scene {
    const struct box *box;
    size_t count;       ///< particles
    double cutoff;      ///< what the list is complete for [λ]
    double temperature; ///< [k_B T_0]
    double time_step;   ///< [τ]
    double free_step;   ///< of dynamics without velocities, sqrt(2 D Δt) [λ]
    double drift;       ///< the same, speed of each particle [λ/τ]; both 0: particles fly
};

/// The skin [λ] for which a step is expected to take the least time; 0 means a list at every step.
///
/// A wide skin makes a long list that is gone through at every step, a narrow one makes many lists.
/// The list lasts until the fastest of N particles has moved by half the skin, at a speed of about
/// sqrt(2 ln N) thermal ones, as if it met nobody; without velocities it walks at random. Depends
/// on the scene alone, never on a clock, so that runs can be repeated to the bit.
double mf_skin_choose(const struct skin_scene *scene);

/// Steps that a list with this skin is expected to last, at least 1.
double mf_skin_interval(const struct skin_scene *scene, double skin);
