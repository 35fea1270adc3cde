// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/particles.h"

#include "base/memory.h"
#include "base/rng.h"

#include <stdlib.h>

enum status particles_init(struct particles *particles, const struct box *box, size_t count) {
    enum status status = STATUS_OK;
    *particles = (struct particles){.count = count, .box = *box};
    for (int d = 0; d < 3; d++) {
        NEW_ARRAY(particles->position[d], count);
        NEW_ARRAY(particles->velocity[d], count);
        NEW_ARRAY(particles->force[d], count);
        NEW_ARRAY(particles->image[d], count);
        NEW_ARRAY(particles->fraction[d], count + PARTICLES_PADDING);
    }
    NEW_ARRAY(particles->kernel_place, count);
    NEW_ARRAY(particles->kernel_motion, count);
    NEW_ARRAY(particles->kernel_force, count);
    NEW_ARRAY(particles->id, count);
    NEW_ARRAY(particles->spare, count);
    for (size_t k = 0; k < count; k++)
        particles->id[k] = (uint32_t)k;
done:
    if (status != STATUS_OK)
        particles_clear(particles);
    return status;
}

void particles_clear(struct particles *particles) {
    for (int d = 0; d < 3; d++) {
        memory_free(particles->position[d]);
        memory_free(particles->velocity[d]);
        memory_free(particles->force[d]);
        memory_free(particles->image[d]);
        memory_free(particles->fraction[d]);
    }
    memory_free(particles->kernel_place);
    memory_free(particles->kernel_motion);
    memory_free(particles->kernel_force);
    memory_free(particles->id);
    memory_free(particles->spare);
    *particles = (struct particles){0};
}

double particles_density(const struct particles *particles) {
    return (double)particles->count / box_volume(&particles->box);
}

void particles_wrap(struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double length = particles->box.length[d];
        double *x = particles->position[d];
        for (size_t k = 0; k < particles->count; k++) {
            const double boxes = floor(x[k] / length);
            const double inside = x[k] - boxes * length;
            // A tiny negative x rounds to exactly `length`: that is the next box's corner.
            const double carry = inside >= length ? 1 : 0;
            x[k] = inside - carry * length;
            particles->image[d][k] += (int32_t)(boxes + carry);
        }
    }
}

void particles_update_fractions(struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double inverse_length = 1 / particles->box.length[d];
        const double *x = particles->position[d];
        int32_t *fraction = particles->fraction[d];
        for (size_t k = 0; k < particles->count; k++)
            fraction[k] = box_fraction(x[k], inverse_length);
        for (size_t k = 0; k < particles->count; k++)
            particles->kernel_place[k].fraction[d] = fraction[k];
    }
}

void particles_update_motion(struct particles *particles, double ahead) {
    struct particle_motion *restrict motion = particles->kernel_motion;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *restrict v = particles->velocity[d], *restrict force = particles->force[d];
        for (size_t k = 0; k < particles->count; k++)
            motion[k].velocity[d] = (float)(v[k] + ahead * force[k]);
    }
    for (size_t k = 0; k < particles->count; k++)
        motion[k].id = particles->id[k];
}

static void permute_doubles(double **array, double **spare, const uint32_t *order, size_t count) {
    for (size_t k = 0; k < count; k++)
        (*spare)[k] = (*array)[order[k]];
    double *permuted = *spare;
    *spare = *array;
    *array = permuted;
}

static void permute_words(uint32_t *array, double *spare, const uint32_t *order, size_t count) {
    uint32_t *copy = (void *)spare;
    memcpy(copy, array, count * sizeof *array);
    for (size_t k = 0; k < count; k++)
        array[k] = copy[order[k]];
}

void particles_permute(struct particles *particles, const uint32_t *order) {
    const size_t count = particles->count;
    for (int d = 0; d < particles->box.dimensions; d++) {
        permute_doubles(&particles->position[d], &particles->spare, order, count);
        permute_doubles(&particles->velocity[d], &particles->spare, order, count);
        permute_doubles(&particles->force[d], &particles->spare, order, count);
        permute_words((uint32_t *)particles->image[d], particles->spare, order, count);
    }
    permute_words(particles->id, particles->spare, order, count);
}

void particles_draw_velocities(struct particles *particles, double temperature, uint64_t seed) {
    const double scale = sqrt(temperature);
    for (size_t k = 0; k < particles->count; k++) {
        double normal[4];
        rng_normal4(rng_philox(seed, RNG_VELOCITIES, particles->id[k], 0, 0), normal);
        for (int d = 0; d < particles->box.dimensions; d++)
            particles->velocity[d][k] = scale * normal[d];
    }
    particles_remove_momentum(particles);
}

void particles_remove_momentum(struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *v = particles->velocity[d], sum = 0;
        for (size_t k = 0; k < particles->count; k++)
            sum += v[k];
        const double mean = sum / (double)particles->count;
        for (size_t k = 0; k < particles->count; k++)
            v[k] -= mean;
    }
}

double particles_square_velocities(const struct particles *particles) {
    double sum = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *v = particles->velocity[d];
#pragma omp simd reduction(+ : sum)
        for (size_t k = 0; k < particles->count; k++)
            sum += v[k] * v[k];
    }
    return sum;
}

double particles_temperature(const struct particles *particles) {
    double squares = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *v = particles->velocity[d];
        double mean = 0;
        for (size_t k = 0; k < particles->count; k++)
            mean += v[k];
        mean /= (double)particles->count;
        for (size_t k = 0; k < particles->count; k++)
            squares += (v[k] - mean) * (v[k] - mean);
    }
    return squares / (particles->box.dimensions * ((double)particles->count - 1));
}

double particles_largest_force(const struct particles *particles) {
    double largest = 0;
    for (size_t k = 0; k < particles->count; k++) {
        double square = 0;
        for (int d = 0; d < particles->box.dimensions; d++)
            square += particles->force[d][k] * particles->force[d][k];
        if (!(square <= largest))
            largest = square;
        if (isnan(square))
            break;
    }
    return sqrt(largest);
}
