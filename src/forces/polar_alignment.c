// SPDX-License-Identifier: GPL-3.0-or-later
//
// Neighbours turn each other into the same direction: the torque on i is −J Σ_j sin(θ_i − θ_j) over
// all j within the range b, with sin(θ_i − θ_j) = n_j × n_i, so that no angle is computed. F. D. C.
// Farrell, M. C. Marchetti, D. Marenduzzo and J. Tailleur, Phys. Rev. Lett. 108, 248101 (2012).
// Tested: test_active.
#include "base/parallel.h"
#include "forces/interaction.h"
#include "system/orientation.h"

struct parameters {
    double coupling, range;
};

static double range_of(const void *parameters) {
    return ((const struct parameters *)parameters)->range;
}

/// A pass over the parts of the list, the even ones and then the odd ones, which share no particle.
struct sweep {
    const struct interaction_pass *pass;
    const struct parameters *parameters;
    struct orientation orientation;
    float scale[2], limit; ///< fractions of the box to lengths, square of the range
    int first;             ///< part
};

/// Σ_j n_j over the neighbours of i; each of them is updated with i at once.
static void turn_around(const struct sweep *sweep, size_t i) {
    const struct particle_place *place = sweep->pass->particles->kernel_place;
    const struct neighbours *neighbours = sweep->pass->neighbours;
    const double *c = sweep->orientation.polarity[0], *s = sweep->orientation.polarity[1];
    const double coupling = sweep->parameters->coupling, ci = c[i], si = s[i];
    const struct particle_place here = place[i];
    double sum = 0;
    for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++) {
        const size_t j = (size_t)neighbours->list[k];
        const float x = sweep->scale[0] *
                        (float)box_fraction_difference(here.fraction[0], place[j].fraction[0]);
        const float y = sweep->scale[1] *
                        (float)box_fraction_difference(here.fraction[1], place[j].fraction[1]);
        if (x * x + y * y > sweep->limit) // what fills a row is i itself: its torque is 0
            continue;
        const double torque = coupling * (s[j] * ci - c[j] * si);
        sum += torque;
        sweep->orientation.torque[j] -= torque;
    }
    sweep->orientation.torque[i] += sum;
}

static void turn_parts(void *context, size_t begin, size_t end) {
    const struct sweep *sweep = context;
    const struct neighbours *neighbours = sweep->pass->neighbours;
    for (size_t n = begin; n < end; n++) {
        const struct neighbours_part *part = &neighbours->part[2 * n + (size_t)sweep->first];
        for (size_t i = part->first; i < part->last; i++)
            turn_around(sweep, i);
    }
}

static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    const struct parameters *own = parameters;
    const struct particles *particles = pass->particles;
    const int parts = pass->neighbours->parts;
    struct sweep sweep = {.pass = pass,
                          .parameters = own,
                          .orientation = mf_orientation_of(particles),
                          .limit = (float)(own->range * own->range)};
    (void)state;
    if (pass->conservative)
        return STATUS_OK;
    for (int d = 0; d < 2; d++)
        sweep.scale[d] = (float)(particles->box.length[d] * 0x1p-32);
    for (sweep.first = 0; sweep.first < 2 && sweep.first < parts; sweep.first++)
        mf_parallel_for((size_t)(parts + 1) / 2, particles->threads, turn_parts, &sweep);
    return STATUS_OK;
}

static const struct field fields[] = {
    {"coupling", FIELD_NUMBER, offsetof(struct parameters, coupling), .required = true,
     .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = "k_B T_0",
     .help = "J, strength of the torques"},
    {"range", FIELD_NUMBER, offsetof(struct parameters, range), .required = true,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "lambda", .help = "b, the range"},
    FIELD_END,
};

const struct interaction mf_polar_alignment = {
    .name = "polar-alignment",
    .summary = "neighbours turn into the same direction: torques -J sin(theta_i - theta_j)",
    .fields = fields,
    .parameters_size = sizeof(struct parameters),
    .oriented = true,
    .cost = 15,
    .finds_pairs = true,
    .range = range_of,
    .add = add,
    .laplacian = mf_interaction_no_laplacian,
};
