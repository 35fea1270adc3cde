// SPDX-License-Identifier: GPL-3.0-or-later
//
// What acts beside the pairs, by itself: forces and Laplacians of potentials at the present places.
#include "dynamics/simulation.h"

static struct interaction_pass potentials_alone(const struct simulation *simulation,
                                                struct particles *particles) {
    return (struct interaction_pass){.law = &simulation->law,
                                     .particles = particles,
                                     .neighbours = &simulation->neighbours,
                                     .step = simulation->step,
                                     .conservative = true,
                                     .wants = PAIR_FORCES};
}

enum status mf_simulation_interaction_forces(const struct simulation *simulation,
                                             bool (*wanted)(const struct interaction *kind),
                                             double *const force[3]) {
    struct particles elsewhere = simulation->particles;
    for (int d = 0; d < elsewhere.box.dimensions; d++)
        elsewhere.force[d] = force[d];
    const struct interaction_pass pass = potentials_alone(simulation, &elsewhere);
    for (int k = 1; k < simulation->interactions; k++) {
        const struct interaction_use *use = &simulation->interaction[k];
        if (wanted(use->choice.kind))
            TRY(use->choice.kind->add(use->choice.parameters, use->state, &pass));
    }
    return STATUS_OK;
}

enum status mf_simulation_interaction_laplacian(const struct simulation *simulation, double *sum) {
    struct particles particles = simulation->particles;
    const struct interaction_pass pass = potentials_alone(simulation, &particles);
    for (int k = 1; k < simulation->interactions; k++) {
        const struct interaction_use *use = &simulation->interaction[k];
        if (use->choice.kind->laplacian)
            TRY(use->choice.kind->laplacian(use->choice.parameters, use->state, &pass, sum));
    }
    return STATUS_OK;
}
