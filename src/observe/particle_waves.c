// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/particle_waves.h"

static const double pi = 3.14159265358979323846;

enum status mf_particle_waves_init(struct particle_waves *waves, const struct box *box,
                                   const struct composition *composition, size_t count,
                                   const struct topology *topology, double q_maximum, size_t bins) {
    const struct box_vectors vectors = mf_box_vectors_of(box);
    *waves = (struct particle_waves){0};
    for (int d = 0; d < box->dimensions; d++)
        waves->unit[d] = 2 * pi / box->length[d];
    TRY(mf_component_sites_init(&waves->sites, box->dimensions, composition, count, topology));
    const struct density_waves_plan plan = {
        .composition = waves->sites.components, .q_maximum = q_maximum, .bins = bins};
    TRY(mf_density_waves_init(&waves->waves, &plan));
    return mf_density_waves_list(&waves->waves, &vectors);
}

void mf_particle_waves_clear(struct particle_waves *waves) {
    mf_density_waves_clear(&waves->waves);
    mf_component_sites_clear(&waves->sites);
    *waves = (struct particle_waves){0};
}

void mf_particle_waves_find(struct particle_waves *waves, const struct particles *particles,
                            int threads) {
    struct density_places places;
    mf_component_sites_find(&waves->sites, particles);
    for (int d = 0; d < 3; d++) {
        places.place[d] = waves->sites.site[d];
        places.unit[d] = waves->unit[d];
    }
    mf_density_waves_find(&waves->waves, &places, threads);
}
