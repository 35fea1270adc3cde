// SPDX-License-Identifier: GPL-3.0-or-later
//
// The same force on every particle, as gravity: U = −Σ F·x, x unwrapped, so that energy is
// conserved through the periodic boundaries. Tested: test_interactions, physics/test_external.
#include "forces/interaction.h"

struct parameters {
    double force[3];
};

static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    const struct parameters *own = parameters;
    const struct particles *particles = pass->particles;
    double path = 0;
    (void)state;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double force = own->force[d], length = particles->box.length[d];
        for (size_t k = 0; k < particles->count; k++)
            particles->force[d][k] += force;
        for (size_t k = 0; k < particles->count && pass->wants == PAIR_FORCES_AND_SUMS; k++)
            path += force * (particles->position[d][k] + particles->image[d][k] * length);
    }
    if (pass->wants == PAIR_FORCES_AND_SUMS)
        pass->sums->energy -= path;
    return STATUS_OK;
}

static const struct field fields[] = {
    {"force", FIELD_LENGTHS, offsetof(struct parameters, force), .required = true,
     .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = "k_B T_0/lambda",
     .help = "force on each particle, along each axis"},
    FIELD_END,
};

const struct interaction mf_uniform_force = {
    .name = "uniform-force",
    .summary = "the same force F on every particle: U = -F.x with x unwrapped",
    .fields = fields,
    .parameters_size = sizeof(struct parameters),
    .cost = 1,
    .add = add,
    .laplacian = mf_interaction_no_laplacian,
};
