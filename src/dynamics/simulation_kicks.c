// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"
#include "base/simd.h"
#include "dynamics/simulation.h"

SIMD_CLONES static void kick_and_drift(void *context, size_t begin, size_t end) {
    struct simulation *simulation = context;
    struct particles *particles = &simulation->particles;
    const double dt = simulation->setup.time_step;
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *restrict x = particles->position[d], *restrict v = particles->velocity[d];
        const double *restrict force = particles->force[d];
        for (size_t k = begin; k < end; k++) {
            v[k] += 0.5 * dt * force[k];
            x[k] += dt * v[k];
        }
    }
}

SIMD_CLONES static void kick_masses_and_drift(void *context, size_t begin, size_t end) {
    struct simulation *simulation = context;
    struct particles *particles = &simulation->particles;
    const double dt = simulation->setup.time_step;
    const double *restrict mass = particles_masses(particles);
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *restrict x = particles->position[d], *restrict v = particles->velocity[d];
        const double *restrict force = particles->force[d];
        for (size_t k = begin; k < end; k++) {
            v[k] += 0.5 * dt * force[k] / mass[k];
            x[k] += dt * v[k];
        }
    }
}

void mf_simulation_kick_and_drift(struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    mf_parallel_for(particles->count, particles->threads,
                    particles_masses(particles) ? kick_masses_and_drift : kick_and_drift,
                    simulation);
}

SIMD_CLONES static void kick(void *context, size_t begin, size_t end) {
    struct simulation *simulation = context;
    struct particles *particles = &simulation->particles;
    const double dt = simulation->setup.time_step;
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *restrict v = particles->velocity[d];
        const double *restrict force = particles->force[d];
        for (size_t k = begin; k < end; k++)
            v[k] += 0.5 * dt * force[k];
    }
}

SIMD_CLONES static void kick_masses(void *context, size_t begin, size_t end) {
    struct simulation *simulation = context;
    struct particles *particles = &simulation->particles;
    const double dt = simulation->setup.time_step;
    const double *restrict mass = particles_masses(particles);
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *restrict v = particles->velocity[d];
        const double *restrict force = particles->force[d];
        for (size_t k = begin; k < end; k++)
            v[k] += 0.5 * dt * force[k] / mass[k];
    }
}

void mf_simulation_kick(struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    mf_parallel_for(particles->count, particles->threads,
                    particles_masses(particles) ? kick_masses : kick, simulation);
}

SIMD_CLONES static void drift_half(void *context, size_t begin, size_t end) {
    struct simulation *simulation = context;
    struct particles *particles = &simulation->particles;
    const double dt = simulation->setup.time_step;
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = begin; k < end; k++)
            particles->position[d][k] += 0.5 * dt * particles->velocity[d][k];
}

void mf_simulation_drift_half(struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    mf_parallel_for(particles->count, particles->threads, drift_half, simulation);
}
