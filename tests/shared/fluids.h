// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The fluids on which the physics is tested, ready to be simulated.
#pragma once

#include "dynamics/simulation.h"

/// A fluid owns its tables; `setup` points to them, so a fluid must stay where it is.
struct fluid {
    struct table potential, omega;
    struct simulation_setup setup;
};

/// Lennard-Jones near its triple point: density 0.8442, temperature 0.7, cutoff 2.5, thermostat
/// ω = 1.5 (1 − r/2.5): dpd-verlet. With setup.omega = NULL and mf_velocity_verlet it is NVE.
void fluid_lennard_jones(struct fluid *fluid, int64_t count, double time_step);

/// The standard fluid of dissipative particle dynamics: density 3, a = 25, γ = 4.5, T = 1, r_c = 1.
/// R. D. Groot and P. B. Warren, J. Chem. Phys. 107, 4423 (1997).
void fluid_groot_warren(struct fluid *fluid, int64_t count, double time_step);

/// The same of three types, with a potential and a friction of its own for each pair type: a =
/// 25 to 40, cutoffs of 0.8 to 1.
void fluid_mixture(struct fluid *fluid, int64_t count, double time_step);

/// Soft discs: density 2, Φ and ω and T of the standard fluid, in two dimensions.
void fluid_soft_discs(struct fluid *fluid, int64_t count, double time_step);

/// Particles without a potential, uniform at random in a box of edge 5: density follows the count.
/// With ω as in the standard fluid; setup.omega = NULL lets them fly freely.
void fluid_ideal_gas(struct fluid *fluid, int dimensions, int64_t count, double time_step);

/// A potential that is 0 everywhere, with a cutoff of 1.
void fluid_no_potential(struct table *table);

void fluid_clear(struct fluid *fluid);

/// Begin `simulation` with `setup` where `from` is now: positions and velocities.
void fluid_continue(struct simulation *simulation, const struct simulation_setup *setup,
                    const struct simulation *from);
