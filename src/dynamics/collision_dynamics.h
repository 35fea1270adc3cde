// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Parameters of collision dynamics.
#pragma once

#include <stdint.h>

struct simulation;
struct simulation_setup;
struct solvent;

/// The angle is α, or drawn for every cell and collision, uniform on the circle: cos α and cos 2α
/// are then 0 on the average, and all that follows holds.
enum collision_angles { COLLISION_FIXED_ANGLES, COLLISION_RANDOM_ANGLES };

enum collision_walls { COLLISION_NO_WALLS, COLLISION_PLATES };

struct collision_dynamics_parameters {
    double cell;               ///< a, edge of a cell                                        [λ]
    double particles_per_cell; ///< M, mean number of solvent particles
    double mass;               ///< m, of a solvent particle                                 [μ]
    double angle;              ///< α                                                  [degrees]
    int angles;                ///< enum collision_angles
    int64_t interval;          ///< time steps from collision to collision
    int thermostat;            ///< 0 or 1: of every cell
    int grid_shift;            ///< 0 or 1
    int hydrodynamics;         ///< 0: beads meet a solvent whose velocities are redrawn
    int walls;                 ///< enum collision_walls
    double wall_filling;       ///< cells that a wall cuts are filled up to so many times M
    double acceleration[3];    ///< g, of all particles                                   [λ/τ²]
    double wave_acceleration;  ///< A of A sin(2π y/L_y) along x                          [λ/τ²]
    double drift[3];           ///< mean velocity of the solvent at the start              [λ/τ]
    double obstacle_centre[3]; ///< [λ]
    double obstacle_radius;    ///< 0: no obstacle                                           [λ]
};

/// The solvent of a simulation; NULL if its integrator has none.
const struct solvent *mf_collision_dynamics_solvent(const struct simulation *simulation);

/// @name Theory
/// Transport coefficients in the bulk by molecular chaos, without hydrodynamic memory. Relative
/// velocities keep in a collision, on the average, the share ρ_1 of themselves and ρ_2 of the
/// products v_x v_y, less the part that the noise of a thermostat decorrelates:
///   ρ_1 = cos α, ρ_2 = cos 2α in two dimensions,
///   ρ_1 = (1 + 2 cos α)/3, ρ_2 = (1 + 2 cos α + 2 cos 2α)/5 in three;
///   with a thermostat, k = d(N − 1)/2:  ρ_1 Γ(k + ½)²/(Γ(k) Γ(k + 1)),  ρ_2 k/(k + 1).
///   S_n = Σ_N P(N) (N − 1)(1 − ρ_n)/M over Poisson's P(N), N ≥ 2;
///   ν = a² S_1/(12 Δt) + (k_B T Δt/m)(1/S_2 − ½).
/// Without a thermostat S_n = (1 − ρ_n)(M − 1 + exp(−M))/M, the results of T. Ihle, E. Tüzel and
/// D. M. Kroll, Phys. Rev. E 72, 046707 (2005), and of N. Kikuchi et al., J. Chem. Phys. 119, 6388
/// (2003). Tested: test_collision_dynamics, physics/test_collision_dynamics.

/// Kinematic viscosity ν [λ²/τ] of a setup with collision dynamics.
double mf_collision_dynamics_viscosity(const struct simulation_setup *setup);

/// Diffusion coefficient [λ²/τ] of a particle of mass `mass` without forces among the solvent:
///   D = (k_B T Δt/mass)(1/s − ½),  s = (1 − ρ_1) Σ_N P(N) m N/(mass + m N),
/// and in place of s the S_1 above for a particle of the solvent's mass. What the flow brings back
/// to a heavy or slow one is not in it.
double mf_collision_dynamics_diffusion(const struct simulation_setup *setup, double mass);
