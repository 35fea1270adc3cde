// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"
#include "base/rng.h"
#include "base/simd.h"
#include "system/particles.h"

double mf_particles_total_mass(const struct particles *particles) {
    const double *mass = particles_masses(particles);
    double sum = 0;
    for (size_t k = 0; mass && k < particles->count; k++)
        sum += mass[k];
    return mass ? sum : (double)particles->count;
}

/// Numbers of variance 1 for the axes of a particle.
static void draw(enum particles_speeds speeds, struct rng_block block, double number[4]) {
    switch (speeds) {
    case PARTICLES_MAXWELL:
    case PARTICLES_NORMAL:
        mf_rng_normal4(block, number);
        break;
    case PARTICLES_UNIFORM:
        for (int d = 0; d < 4; d++)
            number[d] = sqrt(3) * (2 * mf_rng_uniform(block.word[d], 0) - 1);
        break;
    case PARTICLES_SIGNS:
        for (int d = 0; d < 4; d++)
            number[d] = block.word[d] >> 31 ? 1 : -1;
        break;
    }
}

void mf_particles_draw_velocities(struct particles *particles, enum particles_speeds speeds,
                                  double temperature, uint64_t seed) {
    const double *mass = particles_masses(particles);
    const double mean = mf_particles_total_mass(particles) / (double)particles->count;
    for (size_t k = 0; k < particles->count; k++) {
        const double own = mass && speeds == PARTICLES_MAXWELL ? mass[k] : mean;
        double number[4];
        draw(speeds, mf_rng_philox(seed, RNG_VELOCITIES, particles->id[k], 0, 0), number);
        for (int d = 0; d < particles->box.dimensions; d++)
            particles->velocity[d][k] = sqrt(temperature / own) * number[d];
    }
    mf_particles_remove_momentum(particles);
}

double mf_particles_mean_velocity(const struct particles *particles, int axis) {
    const double *v = particles->velocity[axis], *mass = particles_masses(particles);
    double sum = 0;
    for (size_t k = 0; k < particles->count; k++)
        sum += mass ? mass[k] * v[k] : v[k];
    return sum / mf_particles_total_mass(particles);
}

void mf_particles_remove_momentum(struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double mean = mf_particles_mean_velocity(particles, d);
        for (size_t k = 0; k < particles->count; k++)
            particles->velocity[d][k] -= mean;
    }
}

enum { LANES = 8 };

/// Σ m v² of a stretch, or Σ v² without masses, which is constant where this is inlined.
static inline __attribute__((always_inline)) double
sum_squares(const struct particles *particles, const double *mass, size_t begin, size_t end) {
    double sum[LANES] = {0};
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *v = particles->velocity[d] + begin;
        const double *m = mass ? mass + begin : NULL;
        const size_t count = end - begin;
        for (size_t k = 0; k + LANES <= count; k += LANES)
            for (int lane = 0; lane < LANES; lane++)
                sum[lane] += (m ? m[k + lane] : 1) * v[k + lane] * v[k + lane];
        for (size_t k = count / LANES * LANES; k < count; k++)
            sum[0] += (m ? m[k] : 1) * v[k] * v[k];
    }
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

SIMD_CLONES static double square_velocities(const void *context, size_t begin, size_t end) {
    return sum_squares(context, NULL, begin, end);
}

SIMD_CLONES static double kinetic_squares(const void *context, size_t begin, size_t end) {
    return sum_squares(context, particles_masses(context), begin, end);
}

double mf_particles_square_velocities(const struct particles *particles) {
    return mf_parallel_sum(particles->count, particles->threads, square_velocities, particles);
}

double mf_particles_kinetic_energy(const struct particles *particles) {
    return 0.5 *
           (particles_masses(particles)
                ? mf_parallel_sum(particles->count, particles->threads, kinetic_squares, particles)
                : mf_particles_square_velocities(particles));
}

double mf_particles_temperature(const struct particles *particles) {
    const double *mass = particles_masses(particles);
    double squares = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *v = particles->velocity[d];
        const double mean = mf_particles_mean_velocity(particles, d);
        for (size_t k = 0; k < particles->count; k++)
            squares += (mass ? mass[k] : 1) * (v[k] - mean) * (v[k] - mean);
    }
    return squares / (particles->box.dimensions * ((double)particles->count - 1));
}
