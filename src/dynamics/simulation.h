// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A running simulation: owns the state, steps it, watches over it.
#pragma once

#include "base/memory.h"
#include "dynamics/integrator.h"
#include "dynamics/skin.h"
#include "dynamics/thread_count.h"
#include "forces/interaction.h"
#include "forces/pair.h"
#include "forces/pair_memory.h"
#include "system/attributes.h"
#include "system/neighbours.h"
#include "system/placement.h"

#include <stdatomic.h>

/// Everything that defines a simulation, but for its tables. Plain data; copy it freely.
struct simulation_setup {
    struct box box;
    struct placement placement;
    struct composition composition; ///< types of its beads; all zero: they are alike
    struct attributes_source attribute[ATTRIBUTES_NAMES]; ///< that the particles are given
    double temperature;       ///< of the start and of the noise              [k_B T_0]
    double time_step;         ///< Δt                                         [τ]
    double skin;              ///< of the neighbour list; 0: the code chooses [λ]
    double temperature_limit; ///< above limit × temperature: UNSTABLE
    const struct integrator *integrator;
    const void *integrator_parameters; ///< its struct, or NULL: the defaults; borrowed
    /// What acts beside the pairs; its parameters are borrowed.
    struct interaction_choice interaction[INTERACTION_MAX];
    int interactions;
    const struct table *potential; ///< Φ(r), one or for each pair type, or NULL; borrowed
    const struct table *omega;     ///< ω(r), the same, or NULL; borrowed
    struct pair_memory_law memory; ///< friction that remembers, and friction across pairs
    uint64_t seed;
    int precision; ///< enum pair_precision
    /// Set by another thread to stop the simulation, or NULL. Borrowed.
    const atomic_bool *cancel;
    int threads; ///< that a step may take, at least 1: the same bits for any number
};

/// The pairs, all that a scene can name, and one of the caller's own.
enum { SIMULATION_MAX_INTERACTIONS = 1 + INTERACTION_MAX + 1 };

/// What a simulation spends its time on.
enum simulation_phase {
    SIMULATION_MOTION, ///< kicks, drift, watching over it
    SIMULATION_LIST,   ///< sorting and neighbour search
    SIMULATION_FORCES,
    SIMULATION_PHASES
};

struct simulation {
    struct simulation_setup setup;
    struct particles particles;
    struct neighbours neighbours;
    struct pair_law law;
    struct thread_count threads; ///< threads of a step
    struct friction friction;    ///< of an integrator that splits it off
    struct pair_memory memory;   ///< if the setup's acts
    void *integrator_parameters; ///< a copy, which `setup` has for its own
    void *integrator_state;
    struct interaction_use {
        struct interaction_choice choice;
        void *state;
    } interaction[SIMULATION_MAX_INTERACTIONS]; ///< the pairs first
    int interactions;
    uint64_t step;
    enum pair_wants wants; ///< set before a step whose sums will be read
    struct pair_sums sums; ///< of the last step, if it was asked for them
    /// What each step adds its momentum transfer to, or NULL; borrowed. For integrators that tell
    /// it.
    struct transfer *transfer;
    bool velocities_drawn; ///< at the start, and not given by a file
    double temperature;    ///< kinetic, where the integrator's is best; NaN: at the end of a step
    uint64_t list_builds;
    uint64_t ticks[SIMULATION_PHASES]; ///< clock_ticks spent so far
};

/// Positions [λ] and velocities [λ/τ] from a file; shape [count] each.
struct simulation_start {
    const double *position[3];
    const double *velocity[3]; ///< velocity[0] NULL: draw them
};

/// Place the particles, draw their velocities and compute the first forces. Particles placed at
/// random are parted where they overlap (mf_relax_overlaps), molecules always (mf_relax_molecules).
/// @param[in] start  for PLACEMENT_FILE, else NULL
/// Fails: BAD_INPUT (box below twice the cutoff, no room, more neighbours than this machine has
/// memory for), NO_MEMORY, UNSTABLE.
enum status mf_simulation_init(struct simulation *simulation, const struct simulation_setup *setup,
                               const struct simulation_start *start) MUST_USE;
void mf_simulation_clear(struct simulation *simulation);

/// Let an interaction act, after those that are there, from the next pass on.
/// Fails: BAD_INPUT if its parameters do not suit the scene; NO_MEMORY.
enum status mf_simulation_add_interaction(struct simulation *simulation,
                                          const struct interaction_choice *choice) MUST_USE;

/// Forces of the potentials beside the pairs that are `wanted`, added to `force`, shape
/// [dimensions][count]. Fails: as the interactions.
enum status mf_simulation_interaction_forces(const struct simulation *simulation,
                                             bool (*wanted)(const struct interaction *kind),
                                             double *const force[3]) MUST_USE;

/// Σ ∇²U of those that know it, after their forces at the same positions, added to `sum`
/// [k_B T_0/λ²]. Fails: NO_MEMORY.
enum status mf_simulation_interaction_laplacian(const struct simulation *simulation,
                                                double *sum) MUST_USE;

/// Advance by `steps` steps.
/// Fails: UNSTABLE with the step and the largest force in the message as soon as a velocity is not
/// finite or the temperature passes its limit; INTERRUPTED if the user asked to stop.
enum status mf_simulation_run(struct simulation *simulation, uint64_t steps) MUST_USE;

/// @name For integrators
/// v += ½ Δt F/m, then x += Δt v.
void mf_simulation_kick_and_drift(struct simulation *simulation);

/// v += ½ Δt F/m.
void mf_simulation_kick(struct simulation *simulation);

/// x += ½ Δt v.
void mf_simulation_drift_half(struct simulation *simulation);

/// Take the kinetic temperature here, if this step's is wanted.
void mf_simulation_take_temperature(struct simulation *simulation);

/// Rebuild the list if it is stale, set kernel velocities to
/// velocity + ahead · force, and replace the forces by those at the present positions.
enum status mf_simulation_compute_forces(struct simulation *simulation, double ahead) MUST_USE;

/// Energy, virial and forces of the potential at the present positions, for an integrator whose
/// forces belong to the middle of the step.
enum status mf_simulation_compute_potential(struct simulation *simulation) MUST_USE;

/// Kinetic temperature of the last step [k_B T_0], taken where in the step the integrator keeps it
/// best, if the step was asked for its sums, and at the end of the step otherwise; NaN without
/// velocities and of fewer than two particles.
double mf_simulation_temperature(const struct simulation *simulation);

/// Whether particles have velocities, and so a kinetic temperature.
static inline bool simulation_has_velocities(const struct simulation_setup *setup) {
    return setup->integrator->mobility == NULL && !setup->integrator->samples;
}

/// How far a free particle without velocities moves in a step by noise, sqrt(2 k_B T Δt/γ) along an
/// axis [λ].
static inline double simulation_free_step(const struct simulation_setup *setup) {
    return sqrt(2 * setup->temperature * setup->integrator->mobility(setup) * setup->time_step);
}

/// The forces that drive each particle for ever, together [k_B T_0/λ].
double mf_simulation_push(const struct simulation_setup *setup);

/// The first interaction that is about orientations, which particles have for it, or NULL.
const struct interaction *mf_simulation_oriented(const struct simulation_setup *setup);

/// Whether an equilibrium can be expected, at the temperature of the setup: there is one, and no
/// interaction drives or turns particles on its own.
bool mf_simulation_is_thermal(const struct simulation_setup *setup);

/// How many particles move in a step, at least 1: the simulation's and its integrator's own.
static inline double simulation_moved(const struct simulation_setup *setup) {
    const struct integrator *integrator = setup->integrator;
    const double own = integrator->solvent_particles ? integrator->solvent_particles(setup) : 0;
    return fmax(1, (double)setup->placement.count + own);
}

/// Whether friction and noise, or the integrator itself, hold the temperature of the setup.
static inline bool simulation_holds_temperature(const struct simulation_setup *setup) {
    const struct integrator *integrator = setup->integrator;
    return setup->omega || pair_memory_acts(&setup->memory) || !simulation_has_velocities(setup) ||
           (integrator->holds_temperature && integrator->holds_temperature(setup));
}

/// What the neighbour list of a simulation is complete for [λ]: the largest of the cutoffs of its
/// potential and friction weight and the ranges of its interactions. Tested: test_interactions.
double mf_simulation_range(const struct simulation_setup *setup);

/// What the choice of a skin depends on. The integrator's parameters must be given.
struct skin_scene mf_simulation_skin_scene(const struct simulation_setup *setup);

/// Pressure [k_B T_0 / λ^d] from the sums of the last step: ρ k_B T + conservative virial / (d V).
/// T is the set temperature if the dynamics hold it (simulation_holds_temperature) and the kinetic
/// one otherwise.
double mf_simulation_pressure(const struct simulation *simulation);

/// @name Restart
/// The state that, loaded into a simulation made with the same setup and followed by
/// mf_simulation_restore, goes on with the same bits.
enum {
    SIMULATION_SPANS = PARTICLES_SPANS + 5 + INTEGRATOR_SPANS +
                       SIMULATION_MAX_INTERACTIONS * INTERACTION_SPANS + PAIR_MEMORY_SPANS
};
size_t mf_simulation_spans(struct simulation *simulation, struct memory_span *spans);

/// Whether lengths of the spans depend on the first of them: it is then restored before the others,
/// alone, and mf_simulation_reserve is called.
static inline bool simulation_wants_capacity(const struct simulation *simulation) {
    return pair_memory_acts(&simulation->setup.memory);
}
enum status mf_simulation_reserve(struct simulation *simulation) MUST_USE;

/// Rebuild the list as it was when the state was saved. Fails: NO_MEMORY.
enum status mf_simulation_restore(struct simulation *simulation) MUST_USE;
