// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How a simulation moves by one time step: the record of an integrator.
///
/// To add one, write a file with its record, its parameters and its state, and put its name into
/// INTEGRATORS below.
#pragma once

#include "base/fields.h"
#include "base/memory.h"
#include "base/status.h"
#include "forces/friction.h"
#include "system/particles.h"

struct simulation;
struct simulation_setup;

/// What an integrator tells of itself after a run.
struct integrator_number {
    const char *name; ///< in summary.json
    double value;     ///< without a unit
};

/// Temperature and pressure of a configuration [k_B T_0], [k_B T_0/λ^d]; NaN: not known.
struct integrator_told {
    double temperature, pressure;
};

struct integrator {
    const char *name;
    const char *summary;        ///< method and citation, one line
    const struct field *fields; ///< of its parameters
    size_t parameters_size;     ///< of the struct of its parameters; 0: none
    /// Size of what it keeps from step to step, of which a simulation has one, zeroed at first;
    /// numbers of each particle are better an attribute (system/particles.h). 0: nothing.
    size_t state_size;
    /// Begin with the first positions and forces; NULL: the zeros will do.
    enum status (*begin)(struct simulation *simulation);
    void (*clear)(void *state); ///< frees what the state owns; NULL: nothing
    /// List what of the state a checkpoint must keep; returns the number of spans, at most
    /// INTEGRATOR_SPANS. NULL: nothing.
    size_t (*spans)(void *state, struct memory_span *spans);
    /// Rebuild what the spans leave out. Fails: NO_MEMORY. NULL: nothing.
    enum status (*restore)(void *state);
    /// Told before the first sample, and perhaps again: from now on it does not change how it
    /// moves. NULL: it never does.
    void (*settle)(void *state);
    /// What it tells of itself, at most INTEGRATOR_NUMBERS; returns how many. NULL: nothing.
    size_t (*numbers)(const void *state, struct integrator_number *numbers);
    bool dissipative; ///< understands ω(r)
    bool remembers;   ///< and friction that remembers (forces/pair_memory.h)
    /// Moves hard particles from event to event: there are no forces, and kinetic energy is kept.
    bool events;
    /// Draws configurations of the canonical ensemble: a step is a sweep, and there are neither
    /// velocities nor time nor forces. Who looks at a configuration has its forces computed.
    bool samples;
    /// What is known of the present configuration from elsewhere, of whose potential ours is but a
    /// part. NULL: all is ours.
    const struct integrator_told *(*tell)(const void *state);
    /// The time step is a property of what is modelled, and no approximation: fits may look for it.
    bool model_time_step;
    /// Tells a simulation's `transfer` all impulses of pairs: those that are forces when these are
    /// computed, others by itself. Momentum is conserved.
    bool records_momentum_transfer;
    bool masses; ///< moves particles of different masses; else a scene with any is refused
    /// What it makes of ω, if it splits friction and noise off the forces; NULL: they are forces.
    const struct friction_method *friction;
    /// A step begins with the friction of the pairs that the last one kept.
    bool friction_first;
    /// Forces are computed in the middle of the step: those at its end take a pass of their own.
    bool forces_midway;
    /// Dynamics without velocities say here how fast a force moves a particle, 1/γ [τ/μ]. They have
    /// no kinetic temperature; `velocity` is what a particle moved in the last step, over Δt. NULL:
    /// there are velocities.
    double (*mobility)(const struct simulation_setup *setup);
    /// The same of a torque, if they turn orientations (system/orientation.h) [τ/(μ λ²)]. NULL:
    /// they turn none.
    double (*orientation_mobility)(const struct simulation_setup *setup);
    /// Dynamics whose noise outlasts a step take here from positions, shape [dimensions, count] by
    /// particle id, what their next steps will still share with the last [λ]: displacements between
    /// what is left have no memory. Likewise from orientations, shape [count], or NULL. NULL:
    /// positions are that already.
    void (*remove_correlated)(const struct simulation *simulation, double *positions,
                              double *angles);
    /// Particles of its own that it moves beside those of the simulation, of which there may then
    /// be none, and what one costs a step in nanoseconds, for --explain. NULL: it has none.
    double (*solvent_particles)(const struct simulation_setup *setup);
    double solvent_cost;
    /// Whether it holds the temperature of the setup by itself. NULL: not without ω.
    bool (*holds_temperature)(const struct simulation_setup *setup);
    /// What a person should know of the parameters before a simulation, one line naming the key;
    /// NULL: nothing.
    const char *(*warning)(const struct simulation_setup *setup);
    /// Advance by one step, with one call of mf_simulation_compute_forces if it knows forces.
    enum status (*step)(struct simulation *simulation);
};

enum { INTEGRATOR_SPANS = PARTICLES_SPANS + 10, INTEGRATOR_NUMBERS = 5 };

/// All integrators, in the order in which they are listed.
#define INTEGRATORS(EACH)                                                                          \
    EACH(mf_velocity_verlet)                                                                       \
    EACH(mf_dpd_verlet)                                                                            \
    EACH(mf_dpd_vv)                                                                                \
    EACH(mf_shardlow)                                                                              \
    EACH(mf_aboba)                                                                                 \
    EACH(mf_aboba_implicit)                                                                        \
    EACH(mf_lowe_andersen)                                                                         \
    EACH(mf_brownian)                                                                              \
    EACH(mf_brownian_euler)                                                                        \
    EACH(mf_event_driven)                                                                          \
    EACH(mf_collision_dynamics)                                                                    \
    EACH(mf_monte_carlo)

#define INTEGRATOR_DECLARE(record) extern const struct integrator record;
INTEGRATORS(INTEGRATOR_DECLARE)
#undef INTEGRATOR_DECLARE

/// The same, NULL-terminated.
extern const struct integrator *const mf_integrator_list[];
