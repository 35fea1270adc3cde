// SPDX-License-Identifier: GPL-3.0-or-later
//
// A spring to a point: U = ½ Σ k_d s_d², s the way from the centre to the nearest image, F = −k s.
// At half a box from the centre the force jumps: a trap is stiff enough that nobody gets there.
// Tested: test_interactions, physics/test_external, physics/test_brownian.
#include "forces/interaction.h"

struct parameters {
    double stiffness[3];
    double centre[3];
};

static enum status begin(const void *parameters, void *state, const struct particles *particles) {
    static const double max_boxes = 100; // farther away it is in other units, as nm and pm
    const struct parameters *own = parameters;
    (void)state;
    for (int d = 0; d < particles->box.dimensions; d++)
        if (!(fabs(own->centre[d]) <= max_boxes * particles->box.length[d]))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "interactions.harmonic-trap.centre[%d]: %g" STATUS_LENGTH
                                  " is more than %g boxes "
                                  "of %g" STATUS_LENGTH " away",
                                  d, own->centre[d], max_boxes, particles->box.length[d]);
    return STATUS_OK;
}

static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    const struct parameters *own = parameters;
    const struct particles *particles = pass->particles;
    double energy = 0;
    (void)state;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double length = particles->box.length[d], stiffness = own->stiffness[d];
        for (size_t k = 0; k < particles->count && stiffness > 0; k++) {
            const double s = box_nearest(particles->position[d][k] - own->centre[d], length);
            particles->force[d][k] -= stiffness * s;
            energy += 0.5 * stiffness * s * s;
        }
    }
    if (pass->wants == PAIR_FORCES_AND_SUMS)
        pass->sums->energy += energy;
    return STATUS_OK;
}

static enum status laplacian(const void *parameters, void *state,
                             const struct interaction_pass *pass, double *sum) {
    const struct parameters *own = parameters;
    (void)state;
    for (int d = 0; d < pass->particles->box.dimensions; d++)
        *sum += (double)pass->particles->count * own->stiffness[d];
    return STATUS_OK;
}

static const struct field fields[] = {
    {"stiffness", FIELD_LENGTHS, offsetof(struct parameters, stiffness), .required = true,
     .minimum = 0, .maximum = DBL_MAX, .unit = "k_B T_0/lambda^2",
     .help = "k along each axis; 0: free"},
    {"centre", FIELD_LENGTHS, offsetof(struct parameters, centre), .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "lambda",
     .help = "centre of the trap; default: the corner of the box"},
    FIELD_END,
};

const struct interaction mf_harmonic_trap = {
    .name = "harmonic-trap",
    .summary = "spring to a point: U = (k_x s_x^2 + k_y s_y^2 + k_z s_z^2)/2",
    .fields = fields,
    .parameters_size = sizeof(struct parameters),
    .cost = 2,
    .add = add,
    .laplacian = laplacian,
    .begin = begin,
};
