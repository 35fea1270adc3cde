// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/configuration.h"

struct configuration mf_configuration_of(struct simulation *simulation) {
    const struct simulation_setup *const setup = &simulation->setup;
    return (struct configuration){.simulation = simulation,
                                  .dimensions = setup->box.dimensions,
                                  .threads = setup->threads,
                                  .count = simulation->particles.count,
                                  .box = mf_box_vectors_of(&simulation->particles.box),
                                  .composition = &setup->composition,
                                  .molecules =
                                      mf_molecules_find(setup->interaction, setup->interactions),
                                  .temperature = setup->temperature,
                                  .time_step = setup->time_step,
                                  .sweeps = setup->integrator && setup->integrator->samples,
                                  .particles = &simulation->particles};
}

struct composition mf_configuration_types(const struct configuration *configuration) {
    return composition_is_mixed(configuration->composition)
               ? *configuration->composition
               : mf_composition_of_one((int64_t)configuration->count);
}

void mf_configuration_shares(const struct configuration *configuration, int axis, double *share) {
    const struct particles *const particles = configuration->particles;
    if (configuration->fraction)
        for (size_t k = 0; k < configuration->count; k++)
            share[k] = 0x1p-32 * configuration->fraction[axis][k];
    else
        for (size_t k = 0; k < configuration->count; k++)
            share[particles->id[k]] =
                particles->position[axis][k] * configuration->box.inverse[axis][axis];
}

bool mf_configuration_leaves_out(const struct configuration *configuration, uint32_t a,
                                 uint32_t b) {
    const struct topology *const topology =
        configuration->particles ? configuration->particles->topology : NULL;
    if (configuration->molecule)
        return configuration->molecule[a] == configuration->molecule[b];
    if (topology == NULL)
        return false;
    for (size_t n = topology->excluded_start[a]; n < topology->excluded_start[a + 1]; n++)
        if (topology->excluded[n] == b)
            return true;
    return false;
}
