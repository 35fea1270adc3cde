// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/unstable.h"

#include "base/visible.h"

#include <stdio.h>

enum { ADVICE_SIZE = 160 };

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

static void advise(const struct simulation *simulation, char advice[ADVICE_SIZE]) {
    static const double part = 0.5;
    const double largest = mf_particles_largest_force(&simulation->particles);
    snprintf(advice, ADVICE_SIZE, "lower \"time_step\" or soften the potential");
    for (int k = 1; k < simulation->interactions; k++) {
        const struct interaction_use *use = &simulation->interaction[k];
        if (largest_of(simulation, use) > part * largest)
            snprintf(advice, ADVICE_SIZE,
                     "most of it from \"%s\", in which particles may have begun far up: weaken it, "
                     "or lower \"time_step\"",
                     use->choice.kind->name);
    }
}

enum status mf_unstable_fail(const struct simulation *simulation, const char *what) {
    char advice[ADVICE_SIZE];
    advise(simulation, advice);
    return mf_status_fail(
        STATUS_UNSTABLE, "unstable at step %llu: %s, largest force %.3g" STATUS_FORCE "; %s",
        (unsigned long long)simulation->step, what,
        mf_visible_number(mf_particles_largest_force(&simulation->particles)), advice);
}
