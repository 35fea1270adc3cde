// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/orientation.h"

#include "base/rng.h"

static const struct particles_attribute *find(const struct particles *particles, const char *name) {
    for (int k = 0; k < particles->attributes; k++)
        if (strcmp(particles->attribute[k].name, name) == 0)
            return &particles->attribute[k];
    return NULL;
}

enum status mf_orientation_give(struct particles *particles, uint64_t seed) {
    const struct particles_attribute wanted[] = {
        {.name = "orientation", .type = PARTICLES_DOUBLE, .components = 1},
        {.name = "polarity", .type = PARTICLES_DOUBLE, .components = 2},
        {.name = "heading", .type = PARTICLES_DOUBLE, .components = 2},
        {.name = "torque", .type = PARTICLES_DOUBLE, .components = 1}};
    const bool given = find(particles, "orientation") != NULL;
    int number;
    for (int k = given; k < 4; k++)
        TRY(mf_particles_add_attribute(particles, &wanted[k], &number));
    const struct orientation orientation = mf_orientation_of(particles);
    for (size_t k = 0; k < particles->count; k++) {
        const struct rng_block block = mf_rng_philox(seed, RNG_PLACEMENT, particles->id[k], 0, 2);
        if (!given)
            orientation.angle[k] = 2 * M_PI * mf_rng_uniform(block.word[0], block.word[1]);
        orientation_polarity(orientation.angle[k], &orientation.polarity[0][k],
                             &orientation.polarity[1][k]);
        for (int d = 0; d < 2; d++)
            orientation.heading[d][k] = orientation.polarity[d][k];
    }
    return STATUS_OK;
}

struct orientation mf_orientation_of(const struct particles *particles) {
    const struct particles_attribute *torque = find(particles, "torque");
    if (torque == NULL)
        return (struct orientation){0};
    const struct particles_attribute *angle = find(particles, "orientation");
    const struct particles_attribute *polarity = find(particles, "polarity");
    const struct particles_attribute *heading = find(particles, "heading");
    return (struct orientation){.angle = angle->value[0],
                                .polarity = {polarity->value[0], polarity->value[1]},
                                .heading = {heading->value[0], heading->value[1]},
                                .torque = torque->value[0]};
}

void mf_orientation_clear_torques(const struct particles *particles) {
    const struct orientation orientation = mf_orientation_of(particles);
    if (orientation.torque)
        memset(orientation.torque, 0, particles->count * sizeof *orientation.torque);
}
