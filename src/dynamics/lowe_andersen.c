// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation.h"

#include <gsl/gsl_cdf.h>

/// Pairs collide with the heat bath with the probability that makes u decay, on average, as the
/// friction ω² does: exp(−2 ω² Δt).
static double probability(double omega, double time_step) {
    return -expm1(-2 * omega * omega * time_step);
}

/// The kick is the bare number ζ until draw_collisions.
static const struct friction_method collisions = {.damping = probability, .uniform = true};

/// Decide who collides: a uniform number below the probability p says so, and divided by p it is a
/// uniform number again, which becomes the normal one of the new u.
static void draw_collisions(struct friction *friction, double temperature) {
    for (int part = 0; part < friction->parts; part++)
        for (size_t k = friction->begin[part]; k < friction->end[part]; k++) {
            struct friction_pair *pair = &friction->pair[k];
            const double chance = pair->damping, uniform = pair->kick / sqrt(12) + 0.5;
            const bool collides = 0 < uniform && uniform < chance;
            pair->damping = collides ? 0.5F : 0;
            pair->kick = collides ? (float)(0.5 * sqrt(2 * temperature) *
                                            gsl_cdf_ugaussian_Pinv(uniform / chance))
                                  : 0;
        }
}

static enum status step(struct simulation *simulation) {
    mf_simulation_kick_and_drift(simulation);
    TRY(mf_simulation_compute_forces(simulation, 0));
    mf_simulation_kick(simulation);
    if (simulation->setup.omega) {
        draw_collisions(&simulation->friction, simulation->setup.temperature);
        mf_friction_sweep(&simulation->friction, &simulation->particles, simulation->transfer);
    }
    return STATUS_OK;
}

static const struct field fields[] = {FIELD_END};

const struct integrator mf_lowe_andersen = {
    .name = "lowe-andersen",
    .summary = "velocity Verlet, then collisions of pairs with a heat bath; C. P. Lowe, Europhys. "
               "Lett. 47, 145 (1999)",
    .fields = fields,
    .dissipative = true,
    .records_momentum_transfer = true,
    .friction = &collisions,
    .step = step,
};
