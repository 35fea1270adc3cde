// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/own_force.h"

static enum status add(void *state, struct particles *particles, uint64_t step,
                       enum pair_wants wants, struct pair_sums *sums) {
    const struct own_force *own = state;
    const double *position[3] = {particles->position[0], particles->position[1],
                                 particles->position[2]};
    (void)step;
    const double energy =
        own->function(own->context, particles->count, particles->id, position, particles->force);
    if (wants == PAIR_FORCES_AND_SUMS)
        sums->energy += energy;
    return STATUS_OK;
}

const struct interaction mf_own_force = {
    .name = "own",
    .summary = "a function of the caller's",
    .add = add,
};
