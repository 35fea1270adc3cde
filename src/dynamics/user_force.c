// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/user_force.h"

static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    const struct user_force *own = parameters;
    const struct particles *particles = pass->particles;
    const double *position[3] = {particles->position[0], particles->position[1],
                                 particles->position[2]};
    (void)state;
    if (own->function == NULL)
        return STATUS_OK;
    const double energy =
        own->function(own->context, particles->count, particles->id, position, particles->force);
    if (pass->wants == PAIR_FORCES_AND_SUMS)
        pass->sums->energy += energy;
    return STATUS_OK;
}

const struct interaction mf_user_force = {
    .name = "own",
    .summary = "a function of the caller's",
    .parameters_size = sizeof(struct user_force),
    .add = add,
};
