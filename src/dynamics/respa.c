// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/respa.h"

#include "base/parallel.h"
#include "base/simd.h"
#include "dynamics/simulation.h"

static bool is_fast(const struct interaction *kind) {
    return !kind->finds_pairs;
}

static bool has_fast(const struct simulation_setup *setup) {
    for (int k = 0; k < setup->interactions; k++)
        if (is_fast(setup->interaction[k].kind))
            return true;
    return false;
}

enum status mf_respa_init(struct respa *respa, const struct simulation *simulation,
                          int64_t inner_steps) {
    if (inner_steps <= 1)
        return STATUS_OK;
    if (!has_fast(&simulation->setup))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "dynamics.inner_steps: only bonds, angles, dihedrals and forces on "
                              "single beads use them, and the scene has none; leave it out");
    for (int d = 0; d < simulation->setup.box.dimensions; d++)
        TRY_ARRAY(respa->fast[d], simulation->particles.count);
    return STATUS_OK;
}

void mf_respa_clear(void *state) {
    struct respa *respa = state;
    for (int d = 0; d < 3; d++)
        mf_memory_free(respa->fast[d]);
}

enum status mf_respa_find(struct respa *respa, const struct simulation *simulation) {
    for (int d = 0; d < simulation->setup.box.dimensions; d++)
        memset(respa->fast[d], 0, simulation->particles.count * sizeof *respa->fast[d]);
    return mf_simulation_interaction_forces(simulation, is_fast, respa->fast);
}

/// A kick of all particles.
struct kick {
    struct particles *particles;
    double *const *fast;
    double time, drift;
};

/// v += time · (F − fast)/m.
SIMD_CLONES static void kick_slow(void *context, size_t begin, size_t end) {
    const struct kick *kick = context;
    const double *restrict mass = particles_masses(kick->particles);
    const double time = kick->time;
    for (int d = 0; d < kick->particles->box.dimensions; d++) {
        double *restrict v = kick->particles->velocity[d];
        const double *restrict force = kick->particles->force[d], *restrict fast = kick->fast[d];
        if (mass)
            for (size_t k = begin; k < end; k++)
                v[k] += time * (force[k] - fast[k]) / mass[k];
        else
            for (size_t k = begin; k < end; k++)
                v[k] += time * (force[k] - fast[k]);
    }
}

/// v += time · fast/m, then x += drift · v.
SIMD_CLONES static void kick_fast(void *context, size_t begin, size_t end) {
    const struct kick *kick = context;
    const double *restrict mass = particles_masses(kick->particles);
    const double time = kick->time, drift = kick->drift;
    for (int d = 0; d < kick->particles->box.dimensions; d++) {
        double *restrict v = kick->particles->velocity[d];
        double *restrict x = kick->particles->position[d];
        const double *restrict fast = kick->fast[d];
        for (size_t k = begin; k < end; k++)
            v[k] += time * (mass ? fast[k] / mass[k] : fast[k]);
        for (size_t k = begin; k < end; k++)
            x[k] += drift * v[k];
    }
}

static void act(const struct respa *respa, struct simulation *simulation,
                void (*part)(void *, size_t, size_t), double time, double drift) {
    struct kick kick = {&simulation->particles, respa->fast, time, drift};
    mf_parallel_for(simulation->particles.count, simulation->particles.threads, part, &kick);
}

void mf_respa_kick(const struct respa *respa, struct simulation *simulation, double time) {
    act(respa, simulation, kick_slow, time, 0);
}

enum status mf_respa_drift(struct respa *respa, struct simulation *simulation, double time,
                           int64_t steps) {
    const double each = time / (double)steps;
    for (int64_t k = 0; k < steps; k++) {
        act(respa, simulation, kick_fast, 0.5 * each, each);
        TRY(mf_respa_find(respa, simulation));
        act(respa, simulation, kick_fast, 0.5 * each, 0);
    }
    return STATUS_OK;
}

enum status mf_respa_compute_forces(struct respa *respa, struct simulation *simulation) {
    const uint64_t list_builds = simulation->list_builds;
    TRY(mf_simulation_compute_forces(simulation, 0));
    return simulation->list_builds == list_builds ? STATUS_OK : mf_respa_find(respa, simulation);
}

/// Forces of others than the last step's may stand at its beginning, where it was refused, and what
/// was fast is found again.
enum status mf_respa_step(struct respa *respa, struct simulation *simulation, int64_t inner_steps) {
    const double time_step = simulation->setup.time_step;
    TRY(mf_respa_find(respa, simulation));
    mf_respa_kick(respa, simulation, 0.5 * time_step);
    TRY(mf_respa_drift(respa, simulation, time_step, inner_steps));
    TRY(mf_respa_compute_forces(respa, simulation));
    mf_respa_kick(respa, simulation, 0.5 * time_step);
    return STATUS_OK;
}

/// Where they are in the parameters; NULL in those of an integrator without.
static int64_t *find_field(const struct integrator *integrator, const void *parameters) {
    const struct field *field = integrator->fields;
    while (field && field->name && strcmp(field->name, "inner_steps") != 0)
        field++;
    return parameters && field && field->name ? (int64_t *)((char *)parameters + field->offset)
                                              : NULL;
}

int64_t mf_respa_inner_steps(const struct integrator *integrator, const void *parameters) {
    const int64_t *const inner_steps = find_field(integrator, parameters);
    return inner_steps ? *inner_steps : 1;
}

void mf_respa_set(const struct integrator *integrator, void *parameters, int64_t inner_steps) {
    int64_t *const field = find_field(integrator, parameters);
    if (field)
        *field = inner_steps;
}

bool mf_respa_acts(const struct simulation_setup *setup) {
    return mf_respa_inner_steps(setup->integrator, setup->integrator_parameters) > 1;
}
