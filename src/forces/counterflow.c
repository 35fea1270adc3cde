// SPDX-License-Identifier: GPL-3.0-or-later
//
// Flow through a periodic box without walls: one half of it is driven forward, the other backward,
// and each flows as between plates that stand where the halves meet. The profile of a half of width
// H = L/2 is v = F ρ y (H − y)/(2η): it measures the viscosity η. The force has no potential.
// Tested: test_interactions, physics/test_external.
#include "forces/interaction.h"

struct parameters {
    double force;
    int along, across;
};

static enum status begin(const void *parameters, void *state, const struct particles *particles) {
    const struct parameters *own = parameters;
    const int dimensions = particles->box.dimensions;
    (void)state;
    if (own->along != own->across && own->along < dimensions && own->across < dimensions)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "counterflow: \"along\" and \"across\" must be two axes of the box");
}

static enum status add(const void *parameters, void *state, const struct interaction_pass *pass) {
    const struct parameters *own = parameters;
    const struct particles *particles = pass->particles;
    const double inverse_length = 1 / particles->box.length[own->across];
    const double *across = particles->position[own->across];
    double *force = particles->force[own->along];
    (void)state;
    if (pass->conservative)
        return STATUS_OK;
    for (size_t k = 0; k < particles->count; k++) {
        const double fraction = across[k] * inverse_length;
        force[k] += fraction - floor(fraction) < 0.5 ? own->force : -own->force;
    }
    return STATUS_OK;
}

static const char *const axes[] = {"x", "y", "z", NULL};

static const struct field fields[] = {
    {"force", FIELD_NUMBER, offsetof(struct parameters, force), .required = true,
     .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = "k_B T_0/lambda",
     .help = "on each particle of the lower half; the others get the opposite one"},
    {"along", FIELD_CHOICE, offsetof(struct parameters, along), .choices = axes, .initial = 0,
     .unit = "", .help = "axis of the force and of the flow"},
    {"across", FIELD_CHOICE, offsetof(struct parameters, across), .choices = axes, .initial = 1,
     .unit = "", .help = "axis that is cut into halves"},
    FIELD_END,
};

const struct interaction mf_counterflow = {
    .name = "counterflow",
    .summary = "two opposite flows, each as between plates; J. A. Backer et al., J. Chem. Phys. "
               "122, 154503 (2005)",
    .fields = fields,
    .parameters_size = sizeof(struct parameters),
    .cost = 1,
    .begin = begin,
    .add = add,
};
