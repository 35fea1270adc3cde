// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tested: physics/test_molecules_hybrid.
#include "dynamics/respa.h"

#include "base/simd.h"
#include "dynamics/simulation.h"

struct state {
    double *fast[3]; ///< forces beside the pairs, shape [particles]
};

static const struct field fields[] = {
    {"inner", FIELD_INTEGER, .offset = offsetof(struct respa_parameters, inner), .initial = 1,
     .minimum = 1, .maximum = 1000, .unit = "", .help = "steps of the forces beside the pairs"},
    FIELD_END,
};

static enum status begin(struct simulation *simulation) {
    enum status status = STATUS_OK;
    struct state *s = simulation->integrator_state;
    for (int d = 0; d < simulation->setup.box.dimensions; d++)
        NEW_ARRAY(s->fast[d], simulation->particles.count);
done:
    return status;
}

static void clear(void *state) {
    struct state *s = state;
    for (int d = 0; d < 3; d++)
        mf_memory_free(s->fast[d]);
}

static enum status find_fast(const struct simulation *simulation) {
    struct state *s = simulation->integrator_state;
    for (int d = 0; d < simulation->setup.box.dimensions; d++)
        memset(s->fast[d], 0, simulation->particles.count * sizeof *s->fast[d]);
    return mf_simulation_forces_beside(simulation, s->fast);
}

/// v += time · (F − fast).
SIMD_CLONES static void kick_slow(struct simulation *simulation, double time) {
    struct particles *particles = &simulation->particles;
    const struct state *s = simulation->integrator_state;
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *restrict v = particles->velocity[d];
        const double *restrict force = particles->force[d], *restrict fast = s->fast[d];
        for (size_t k = 0; k < particles->count; k++)
            v[k] += time * (force[k] - fast[k]);
    }
}

/// v += time · fast, then x += drift · v.
SIMD_CLONES static void kick_fast(struct simulation *simulation, double time, double drift) {
    struct particles *particles = &simulation->particles;
    const struct state *s = simulation->integrator_state;
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *restrict v = particles->velocity[d], *restrict x = particles->position[d];
        const double *restrict fast = s->fast[d];
        for (size_t k = 0; k < particles->count; k++) {
            v[k] += time * fast[k];
            x[k] += drift * v[k];
        }
    }
}

/// Forces of others than the last step's may stand at its beginning, where it was refused, and what
/// was fast is found anew; a new list brings the particles into another order.
static enum status step(struct simulation *simulation) {
    const struct respa_parameters *p = simulation->integrator_parameters;
    const double outer = simulation->setup.time_step, inner = outer / (double)p->inner;
    const uint64_t list_builds = simulation->list_builds;
    TRY(find_fast(simulation));
    kick_slow(simulation, 0.5 * outer);
    for (int64_t k = 0; k < p->inner; k++) {
        kick_fast(simulation, 0.5 * inner, inner);
        TRY(find_fast(simulation));
        kick_fast(simulation, 0.5 * inner, 0);
    }
    TRY(mf_simulation_compute_forces(simulation, 0));
    if (simulation->list_builds != list_builds)
        TRY(find_fast(simulation));
    kick_slow(simulation, 0.5 * outer);
    return STATUS_OK;
}

const struct integrator mf_respa = {
    .name = "respa",
    .summary = "reversible multiple time steps; M. Tuckerman, B. J. Berne and G. J. Martyna, J. "
               "Chem. Phys. 97, 1990 (1992)",
    .fields = fields,
    .parameters_size = sizeof(struct respa_parameters),
    .state_size = sizeof(struct state),
    .begin = begin,
    .clear = clear,
    .step = step,
};
