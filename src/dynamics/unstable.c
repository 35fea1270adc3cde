// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/unstable.h"

#include <stdio.h>

/// The largest force that an interaction has now, alone; 0 if that cannot be found.
static double largest_of(const struct simulation *simulation, const struct interaction_use *use) {
    struct particles alone = simulation->particles;
    const struct interaction_pass pass = {.law = &simulation->law,
                                          .particles = &alone,
                                          .neighbours = &simulation->neighbours,
                                          .step = simulation->step,
                                          .conservative = true,
                                          .wants = PAIR_FORCES};
    double *force = mf_memory_zeroed(3 * alone.count, sizeof *force), largest = 0;
    for (int d = 0; d < 3 && force; d++)
        alone.force[d] = force + (size_t)d * alone.count;
    if (force && use->choice.kind->add(use->choice.parameters, use->state, &pass) == STATUS_OK)
        largest = mf_particles_largest_force(&alone);
    mf_memory_free(force);
    return largest;
}

void mf_unstable_advise(const struct simulation *simulation, char advice[UNSTABLE_ADVICE_SIZE]) {
    static const double part = 0.5;
    const double largest = mf_particles_largest_force(&simulation->particles);
    snprintf(advice, UNSTABLE_ADVICE_SIZE, "lower \"time_step\" or soften the potential");
    for (int k = 1; k < simulation->interactions; k++) {
        const struct interaction_use *use = &simulation->interaction[k];
        if (largest_of(simulation, use) > part * largest)
            snprintf(advice, UNSTABLE_ADVICE_SIZE,
                     "most of it from \"%s\", in which particles may have begun far up: weaken it, "
                     "or lower \"time_step\"",
                     use->choice.kind->name);
    }
}
