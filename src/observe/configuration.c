// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/configuration.h"

struct configuration mf_configuration_of(struct simulation *simulation) {
    const struct simulation_setup *const setup = &simulation->setup;
    return (struct configuration){.simulation = simulation,
                                  .dimensions = setup->box.dimensions,
                                  .composition = &setup->composition,
                                  .molecules =
                                      mf_molecules_find(setup->interaction, setup->interactions),
                                  .temperature = setup->temperature,
                                  .time_step = setup->time_step,
                                  .sweeps = setup->integrator && setup->integrator->samples,
                                  .particles = &simulation->particles};
}
