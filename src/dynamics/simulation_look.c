// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation_look.h"

#include <math.h>
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

/// @param[in] transfer  what Σ r_a F_b of the potentials is added to, or NULL
static enum status look_at(const struct simulation *simulation, struct transfer *transfer,
                           struct simulation *look) {
    enum status status = STATUS_OK;
    const struct simulation_setup *setup = &simulation->setup;
    *look = (struct simulation){.setup = *setup, .law = simulation->law, .step = simulation->step};
    look->law.omega = NULL;
    look->law.friction = NULL;
    look->law.histogram = NULL;
    look->law.transfer = transfer;
    CHECK(copy_particles(&simulation->particles, &look->particles));
    CHECK(mf_neighbours_init(&look->neighbours, NEIGHBOURS_HALF, &look->particles.box,
                             look->particles.count, mf_simulation_range(setup), 0));
    for (int k = 0; k < simulation->interactions; k++)
        CHECK(mf_simulation_add_interaction(look, &simulation->interaction[k].choice));
    // Without a skin the list is stale, and built there.
    CHECK(mf_simulation_compute_potential(look));
done:
    if (status != STATUS_OK)
        mf_simulation_clear(look);
    return status;
}

enum status mf_simulation_look(const struct simulation *simulation, struct simulation *look) {
    return look_at(simulation, NULL, look);
}

enum status mf_simulation_look_virial(const struct simulation *simulation, double virial[3][3]) {
    static const double rounding = 1e-3;
    const double count = (double)simulation->particles.count;
    OWNED struct transfer *transfer = NULL;
    struct simulation look;
    TRY_ARRAY(transfer, 1);
    TRY(look_at(simulation, transfer, &look));
    mf_transfer_collect(transfer, look.neighbours.parts, 1);
    const double whole = look.sums.virial,
                 trace = transfer->sum[0][0] + transfer->sum[1][1] + transfer->sum[2][2];
    mf_simulation_clear(&look);
    memcpy(virial, transfer->sum, sizeof transfer->sum);
    if (fabs(trace - whole) > rounding * (fabs(whole) + count * simulation->setup.temperature))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "one of the \"interactions\" tells its pressure, but "
                              "not that along each axis");
    return STATUS_OK;
}
