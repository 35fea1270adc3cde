// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation.h"

static enum status step(struct simulation *simulation) {
    mf_simulation_kick_and_drift(simulation);
    TRY(mf_simulation_compute_forces(simulation, 0));
    mf_simulation_kick(simulation);
    return STATUS_OK;
}

static const struct field fields[] = {FIELD_END};

const struct integrator mf_velocity_verlet = {
    .name = "velocity-verlet",
    .summary =
        "NVE, the default without friction; W. C. Swope et al., J. Chem. Phys. 76, 637 (1982)",
    .fields = fields,
    .masses = true,
    .tells_transfer = true,
    .step = step,
};
