// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Hard discs and spheres on which the event-driven dynamics are tested.
#pragma once

#include "dynamics/event_driven.h"

/// `setup` points to `parameters`, so a gas must stay where it is.
struct hard_gas_scene {
    struct event_driven_parameters parameters;
    struct simulation_setup setup;
};

/// Particles of diameter 1 and mass 1 at a packing fraction, placed at random, temperature 1, in a
/// periodic box.
void hard_gases_make(struct hard_gas_scene *scene, int dimensions, int64_t count, double eta);

/// Two sorts, half of the particles each, with these diameters and masses.
void hard_gases_make_mixture(struct hard_gas_scene *scene, int dimensions, int64_t count,
                             double eta, const double diameter[2], const double mass[2]);

/// The state of a simulation with them.
const struct hard_gas *hard_gases_of(const struct simulation *simulation);

/// Smallest (r − s)/s of all pairs, s the sum of their radii, by all pairs and nearest images, or
/// of a particle and a wall.
double hard_gases_smallest_gap(const struct simulation *simulation);
