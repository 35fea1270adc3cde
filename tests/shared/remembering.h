// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Fluids whose friction remembers.
#pragma once

#include "shared/fluids.h"

/// What remembers, to be added up.
enum remembering_parts {
    REMEMBERING_SLOW = 1,   ///< τ = 0.5, ω = 8 (1 − r/0.9)
    REMEMBERING_RATTLE = 2, ///< τ = 0.1, Ω = 20, ω = 2 up to 1, where it jumps to 0
    REMEMBERING_ACROSS = 4  ///< transverse friction 1.5 (1 − r)
};

/// Owns its tables, to which fluid.setup points: it stays where it is.
struct remembering {
    struct fluid fluid;
    struct table slow, rattle, across;
};

/// The standard fluid (fluid_groot_warren) by ABOBA, with some of these.
void remembering_make(struct remembering *remembering, int64_t count, double time_step, int parts);

/// Give another fluid's setup the same.
void remembering_add(struct remembering *remembering, struct simulation_setup *setup, int parts);
void remembering_clear(struct remembering *remembering);

/// ½ Σ z² of the pairs in range [k_B T_0], and their number of variables: what the extended energy
/// adds to that of the particles.
double remembering_energy(const struct pair_memory *memory, size_t *variables);
