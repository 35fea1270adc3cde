// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tested: test_interactions, physics/test_viscosity.
#include "forces/shear_wave.h"

static enum status begin(const void *parameters, void *state, const struct particles *particles) {
    (void)parameters, (void)state;
    return particles->box.dimensions == 3
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT, "interactions.shear-wave: the wave is along z, "
                                                  "and the box is two-dimensional");
}

static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    const struct shear_wave_parameters *own = parameters;
    const struct particles *particles = pass->particles;
    const double *mass = particles_masses(particles), *z = particles->position[2];
    const double k = shear_wave_number(&particles->box);
    double sum = 0, all = 0;
    (void)state;
    if (pass->conservative) // it has no potential
        return STATUS_OK;
    for (size_t n = 0; n < particles->count; n++) {
        sum += (mass ? mass[n] : 1) * cos(k * z[n]);
        all += mass ? mass[n] : 1;
    }
    const double mean = sum / all;
    for (size_t n = 0; n < particles->count; n++)
        particles->force[0][n] += (mass ? mass[n] : 1) * own->acceleration * (cos(k * z[n]) - mean);
    return STATUS_OK;
}

static const struct field fields[] = {
    {"acceleration", FIELD_NUMBER, offsetof(struct shear_wave_parameters, acceleration),
     .required = true, .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = "lambda/tau^2",
     .help = "A; the flow has the velocity A rho/(eta k^2)"},
    FIELD_END,
};

const struct interaction mf_shear_wave = {
    .name = "shear-wave",
    .summary = "acceleration A cos(kz) along x, k = 2 pi/L_z, to measure the viscosity; B. Hess, "
               "J. Chem. Phys. 116, 209 (2002)",
    .fields = fields,
    .parameters_size = sizeof(struct shear_wave_parameters),
    .cost = 12,
    .begin = begin,
    .add = add,
    .does_work = true,
    .laplacian = mf_interaction_no_laplacian,
};

const struct shear_wave_parameters *
mf_shear_wave_find(const struct interaction_choice *interactions, int count) {
    for (int k = 0; k < count; k++)
        if (interactions[k].kind == &mf_shear_wave)
            return interactions[k].parameters;
    return NULL;
}
