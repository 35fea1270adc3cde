// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/interaction.h"

/// Friction, noise and potential share one pass: nearly all of its time goes into the distances.
static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    (void)parameters;
    (void)state;
    struct pair_law law = *pass->law;
    struct pair_sums sums;
    if (pass->conservative)
        law.omega = NULL;
    mf_pair_add(&law, pass->particles, pass->neighbours, pass->step, pass->wants, &sums);
    mf_pair_gather(pass->particles);
    if (pass->sums) {
        pass->sums->energy += sums.energy;
        pass->sums->virial += sums.virial;
    }
    return STATUS_OK;
}

const struct interaction mf_pairs = {
    .name = "pairs",
    .summary = "Phi(r), friction and noise of pairs; R. D. Groot and P. B. Warren, J. Chem. Phys. "
               "107, 4423 (1997)",
    .add = add,
};
