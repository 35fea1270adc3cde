// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation_look.h"

#include <string.h>

/// All that is sorted and saved with the particles, and their molecules.
static enum status copy_particles(const struct particles *from, struct particles *to) {
    struct particles source = *from;
    struct memory_span taken[PARTICLES_SPANS], given[PARTICLES_SPANS];
    TRY(mf_particles_init(to, &from->box, from->count));
    to->threads = from->threads;
    if (from->precise_place)
        TRY(mf_particles_keep_precise(to));
    TRY(mf_particles_join(to, from->topology));
    for (int k = 0; k < from->attributes; k++) {
        int number;
        TRY(mf_particles_add_attribute(to, &from->attribute[k], &number));
    }
    const size_t spans = mf_particles_spans(&source, taken);
    (void)mf_particles_spans(to, given);
    for (size_t n = 0; n < spans; n++)
        if (taken[n].bytes > 0)
            memcpy(given[n].memory, taken[n].memory, taken[n].bytes);
    return STATUS_OK;
}

enum status mf_simulation_look(const struct simulation *simulation, struct simulation *look) {
    enum status status = STATUS_OK;
    const struct simulation_setup *setup = &simulation->setup;
    *look = (struct simulation){.setup = *setup, .law = simulation->law, .step = simulation->step};
    look->law.omega = NULL;
    look->law.friction = NULL;
    look->law.histogram = NULL;
    look->law.transfer = NULL;
    CHECK(copy_particles(&simulation->particles, &look->particles));
    CHECK(mf_neighbours_init(&look->neighbours, NEIGHBOURS_HALF, &setup->box, look->particles.count,
                             mf_simulation_range(setup), 0));
    for (int k = 0; k < simulation->interactions; k++)
        CHECK(mf_simulation_add_interaction(look, &simulation->interaction[k].choice));
    // Without a skin the list is stale, and built there.
    CHECK(mf_simulation_compute_potential(look));
done:
    if (status != STATUS_OK)
        mf_simulation_clear(look);
    return status;
}
