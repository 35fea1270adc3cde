// SPDX-License-Identifier: GPL-3.0-or-later
//
// A force along its polarity on each particle, F_i = α n_i: it comes from within, moves a free
// particle at v_0 = α/γ, and has no potential. P. Romanczuk, M. Bär, W. Ebeling, B. Lindner and L.
// Schimansky-Geier, Eur. Phys. J. Special Topics 202, 1 (2012). Tested: physics/test_active.
#include "base/parallel.h"
#include "base/simd.h"
#include "forces/interaction.h"
#include "system/orientation.h"

struct parameters {
    double force;
};

static double push(const void *parameters) {
    return fabs(((const struct parameters *)parameters)->force);
}

struct propelled {
    const struct particles *particles;
    double force;
};

SIMD_CLONES static void propel(void *context, size_t begin, size_t end) {
    const struct propelled *propelled = context;
    const struct orientation orientation = mf_orientation_of(propelled->particles);
    for (int d = 0; d < 2; d++) {
        const double *restrict n = orientation.heading[d];
        double *restrict force = propelled->particles->force[d];
        for (size_t k = begin; k < end; k++)
            force[k] += propelled->force * n[k];
    }
}

static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    const struct parameters *own = parameters;
    const struct particles *particles = pass->particles;
    struct propelled propelled = {particles, own->force};
    (void)state;
    if (!pass->conservative)
        mf_parallel_for(particles->count, particles->threads, propel, &propelled);
    return STATUS_OK;
}

static const struct field fields[] = {
    {"force", FIELD_NUMBER, offsetof(struct parameters, force), .required = true, .minimum = 0,
     .maximum = DBL_MAX, .unit = "k_B T_0/lambda", .help = "alpha; the speed is v_0 = alpha/gamma"},
    FIELD_END,
};

const struct interaction mf_self_propulsion = {
    .name = "self-propulsion",
    .summary = "a force alpha n on each particle along its polarity n = (cos theta, sin theta)",
    .fields = fields,
    .parameters_size = sizeof(struct parameters),
    .oriented = true,
    .push = push,
    .cost = 1,
    .add = add,
    .does_work = true,
    .laplacian = mf_interaction_no_laplacian,
};
