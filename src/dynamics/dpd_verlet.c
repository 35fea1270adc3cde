// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/dpd_verlet.h"

#include "dynamics/respa.h"
#include "dynamics/simulation.h"

/// The forces see velocities predicted to v(t) + λ Δt F(t); after the half kick that is
/// v + (λ − ½) Δt F. Friction and noise of a pair do not depend on its masses. What is predicted
/// does: with different masses, and with inner steps, whose forces are not those of the pairs, λ is
/// ½.
static enum status step(struct simulation *simulation) {
    const struct dpd_verlet_parameters *parameters = simulation->setup.integrator_parameters;
    const double lambda = parameters->lambda;
    if (parameters->inner_steps > 1)
        return mf_respa_step(simulation->integrator_state, simulation, parameters->inner_steps);
    mf_simulation_kick_and_drift(simulation);
    TRY(mf_simulation_compute_forces(simulation, (lambda - 0.5) * simulation->setup.time_step));
    mf_simulation_kick(simulation);
    return STATUS_OK;
}

static enum status begin(struct simulation *simulation) {
    const struct dpd_verlet_parameters *parameters = simulation->setup.integrator_parameters;
    if (particles_masses(&simulation->particles) && parameters->lambda != 0.5)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "dynamics.lambda: beads of different masses are moved with 0.5");
    if (parameters->inner_steps > 1 && parameters->lambda != 0.5)
        return mf_status_fail(STATUS_BAD_INPUT, "dynamics.lambda: with \"inner_steps\" it is 0.5");
    return mf_respa_init(simulation->integrator_state, simulation, parameters->inner_steps);
}

static const struct field fields[] = {
    {"lambda", FIELD_NUMBER, offsetof(struct dpd_verlet_parameters, lambda), .initial = 0.5,
     .minimum = 0, .maximum = 1, .unit = "", .help = "velocity prediction, in time steps"},
    RESPA_FIELD(offsetof(struct dpd_verlet_parameters, inner_steps), ""),
    FIELD_END,
};

const struct integrator mf_dpd_verlet = {
    .name = "dpd-verlet",
    .summary = "DPD velocity Verlet; R. D. Groot and P. B. Warren, J. Chem. Phys. 107, 4423 "
               "(1997), eq. 21",
    .fields = fields,
    .parameters_size = sizeof(struct dpd_verlet_parameters),
    .state_size = sizeof(struct respa),
    .dissipative = true,
    .masses = true,
    .records_momentum_transfer = true,
    .begin = begin,
    .clear = mf_respa_clear,
    .step = step,
};
