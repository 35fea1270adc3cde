// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation.h"

/// Half a step explicit, half implicit, pair by pair: with a = ω² Δt,
///   u' = ((1 − a) u + 2 sqrt(2 k_B T a) ζ) / (1 + a).
static double damping(double omega, double time_step) {
    const double a = omega * omega * time_step;
    return a / (1 + a);
}

static double square(double time_step, double temperature) {
    (void)time_step;
    return 2 * temperature;
}

/// u' = (1 − 2d) u + 2 kick keeps the variance 2 k_B T if amplitude² = 2 k_B T d (1 − d).
static const struct friction_method halves = {.damping = damping, .square = square, .bound = 1};

/// S1: friction for a whole step, then velocity Verlet. The pairs are those of the forces at the
/// end of the last step.
static enum status step(struct simulation *simulation) {
    if (simulation->setup.omega)
        mf_friction_sweep(&simulation->friction, &simulation->particles, simulation->transfer);
    mf_simulation_kick_and_drift(simulation);
    TRY(mf_simulation_compute_forces(simulation, 0));
    mf_simulation_kick(simulation);
    return STATUS_OK;
}

static const struct field fields[] = {FIELD_END};

const struct integrator mf_shardlow = {
    .name = "shardlow",
    .summary = "S1 splitting; T. Shardlow, SIAM J. Sci. Comput. 24, 1267 (2003)",
    .fields = fields,
    .dissipative = true,
    .records_momentum_transfer = true,
    .friction = &halves,
    .friction_first = true,
    .step = step,
};
