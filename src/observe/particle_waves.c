// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/particle_waves.h"

#include "base/memory.h"

static const double pi = 3.14159265358979323846;

enum status mf_particle_waves_init(struct particle_waves *waves, const struct box *box,
                                   const struct composition *composition, size_t count,
                                   double q_maximum, size_t bins) {
    enum status status = STATUS_OK;
    const struct density_waves_plan plan = {
        .composition = composition_is_mixed(composition) ? *composition
                                                         : mf_composition_of_one((int64_t)count),
        .q_maximum = q_maximum,
        .bins = bins};
    double lattice[3][3] = {{0}}, length[3] = {0};
    *waves = (struct particle_waves){0};
    for (int d = 0; d < box->dimensions; d++) {
        length[d] = box->length[d];
        lattice[d][d] = waves->unit[d] = 2 * pi / box->length[d];
    }
    CHECK(mf_density_waves_init(&waves->waves, &plan));
    CHECK(mf_density_waves_list(&waves->waves, lattice, length));
    NEW_ARRAY(waves->place, count);
done:
    return status;
}

void mf_particle_waves_clear(struct particle_waves *waves) {
    mf_density_waves_clear(&waves->waves);
    mf_memory_free(waves->place);
    *waves = (struct particle_waves){0};
}

static void tell_angle(const void *context, size_t bead, double angle[3]) {
    const struct particle_waves *const w = context;
    for (int d = 0; d < 3; d++)
        angle[d] = w->unit[d] > 0 ? w->unit[d] * w->particles->position[d][w->place[bead]] : 0;
}

void mf_particle_waves_find(struct particle_waves *waves, const struct particles *particles,
                            int threads) {
    const struct density_angles angles = {tell_angle, waves};
    waves->particles = particles;
    for (size_t k = 0; k < particles->count; k++)
        waves->place[particles->id[k]] = (uint32_t)k;
    mf_density_waves_find(&waves->waves, &angles, threads);
}
