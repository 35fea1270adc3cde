// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/respa.h"
#include "dynamics/simulation.h"

static int64_t inner_steps_of(const struct simulation *simulation) {
    const struct respa_parameters *parameters = simulation->setup.integrator_parameters;
    return parameters->inner_steps;
}

static enum status begin(struct simulation *simulation) {
    return mf_respa_init(simulation->integrator_state, simulation, inner_steps_of(simulation));
}

static enum status step(struct simulation *simulation) {
    if (inner_steps_of(simulation) > 1)
        return mf_respa_step(simulation->integrator_state, simulation, inner_steps_of(simulation));
    mf_simulation_kick_and_drift(simulation);
    TRY(mf_simulation_compute_forces(simulation, 0));
    mf_simulation_kick(simulation);
    return STATUS_OK;
}

static const struct field fields[] = {
    RESPA_FIELD(offsetof(struct respa_parameters, inner_steps), ""),
    FIELD_END,
};

const struct integrator mf_velocity_verlet = {
    .name = "velocity-verlet",
    .summary =
        "NVE, the default without friction; W. C. Swope et al., J. Chem. Phys. 76, 637 (1982)",
    .fields = fields,
    .parameters_size = sizeof(struct respa_parameters),
    .state_size = sizeof(struct respa),
    .masses = true,
    .records_momentum_transfer = true,
    .begin = begin,
    .clear = mf_respa_clear,
    .step = step,
};
