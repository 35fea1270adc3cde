// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Velocity Verlet with shorter steps for the forces of bonds and those on single beads.
///
/// The impulses of beads that find each other, pairs and energies of local densities, act once a
/// step, and between them the others move the particles by steps of their own (reversible reference
/// system propagator: M. Tuckerman, B. J. Berne and G. J. Martyna, J. Chem. Phys. 97, 1990 (1992),
/// eq. 2.20). It is reversible and keeps volumes in phase space, as a proposal of hybrid Monte
/// Carlo must. A step must stay well below half a period of the fastest bond, where the impulses of
/// the pairs resonate with it. Friction and noise of pairs are impulses of theirs.
#pragma once

#include "dynamics/integrator.h"

/// What an integrator that does so keeps.
struct respa {
    double *fast[3]; ///< forces of what takes the inner steps, shape [particles]
};

/// Parameters of integrators that have no others.
struct respa_parameters {
    int64_t inner_steps;
};

/// The field of this, at its place in the parameters, with `more` after its help.
#define RESPA_FIELD(place, more)                                                                   \
    {                                                                                              \
        "inner_steps", FIELD_INTEGER, .offset = place, .initial = 1, .minimum = 1,                 \
                                      .maximum = 1000, .unit = "",                                 \
                                      .help = "bonded steps in a time step (r-RESPA)" more         \
    }

/// Make room, if there is more than one inner step; else nothing.
/// Fails: BAD_INPUT if nothing takes them; NO_MEMORY.
enum status mf_respa_init(struct respa *respa, const struct simulation *simulation,
                          int64_t inner_steps) MUST_USE;
void mf_respa_clear(void *respa);

/// @name The parts of a step, between which positions and fast forces belong to each other

/// Find the fast forces at the present positions.
enum status mf_respa_find(struct respa *respa, const struct simulation *simulation) MUST_USE;

/// v += time · (F − fast)/m, F the forces of all.
void mf_respa_kick(const struct respa *respa, struct simulation *simulation, double time);

/// So many steps of the fast forces alone, in this time.
enum status mf_respa_drift(struct respa *respa, struct simulation *simulation, double time,
                           int64_t steps) MUST_USE;

/// The forces of all, at the present positions; a new list brings the particles into another order,
/// and the fast forces with them.
enum status mf_respa_compute_forces(struct respa *respa, struct simulation *simulation) MUST_USE;

/// Kick, fly, kick: a step of velocity Verlet. Tested: test_respa, physics/test_molecules_hybrid,
/// physics/test_molecules.
enum status mf_respa_step(struct respa *respa, struct simulation *simulation,
                          int64_t inner_steps) MUST_USE;

/// How many an integrator takes by its parameters; 1 of one that has none.
int64_t mf_respa_inner_steps(const struct integrator *integrator, const void *parameters);

/// Set them, of an integrator that has some.
void mf_respa_set(const struct integrator *integrator, void *parameters, int64_t inner_steps);

/// Whether the integrator of a setup has inner steps.
bool mf_respa_acts(const struct simulation_setup *setup);
