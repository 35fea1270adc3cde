// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/particles.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "base/simd.h"

#include <stdlib.h>

enum status mf_particles_init(struct particles *particles, const struct box *box, size_t count) {
    enum status status = STATUS_OK;
    *particles = (struct particles){.count = count, .box = *box, .threads = 1};
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
    NEW_ARRAY(particles->spare_motion, count);
    particles->spare_words = mf_memory_zeroed(count, sizeof(uint32_t));
    CHECK(particles->spare_words ? STATUS_OK : STATUS_NO_MEMORY);
    for (size_t k = 0; k < count; k++)
        particles->id[k] = (uint32_t)k;
done:
    if (status != STATUS_OK)
        mf_particles_clear(particles);
    return status;
}

enum status mf_particles_keep_precise(struct particles *particles) {
    enum status status = STATUS_OK;
    NEW_ARRAY(particles->precise_place, particles->count);
    NEW_ARRAY(particles->precise_motion, particles->count);
    NEW_ARRAY(particles->spare_precise_motion, particles->count);
done:
    return status;
}

void mf_particles_clear(struct particles *particles) {
    for (int d = 0; d < 3; d++) {
        mf_memory_free(particles->position[d]);
        mf_memory_free(particles->velocity[d]);
        mf_memory_free(particles->force[d]);
        mf_memory_free(particles->image[d]);
        mf_memory_free(particles->fraction[d]);
    }
    mf_memory_free(particles->kernel_place);
    mf_memory_free(particles->kernel_motion);
    mf_memory_free(particles->precise_place);
    mf_memory_free(particles->precise_motion);
    mf_memory_free(particles->spare_precise_motion);
    mf_memory_free(particles->kernel_force);
    mf_memory_free(particles->id);
    mf_memory_free(particles->spare);
    mf_memory_free(particles->spare_motion);
    mf_memory_free(particles->spare_words);
    *particles = (struct particles){0};
}

double mf_particles_density(const struct particles *particles) {
    return (double)particles->count / mf_box_volume(&particles->box);
}

SIMD_CLONES static void wrap(void *context, size_t begin, size_t end) {
    struct particles *particles = context;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double length = particles->box.length[d];
        double *restrict x = particles->position[d];
        int32_t *restrict image = particles->image[d];
        for (size_t k = begin; k < end; k++) {
            const double boxes = floor(x[k] / length);
            const double inside = x[k] - boxes * length;
            // A tiny negative x rounds to exactly `length`: that is the next box's corner.
            const double carry = inside >= length ? 1 : 0;
            x[k] = inside - carry * length;
            image[k] += (int32_t)(boxes + carry);
        }
    }
}

void mf_particles_wrap(struct particles *particles) {
    mf_parallel_for(particles->count, particles->threads, wrap, particles);
}

SIMD_CLONES static void update_fractions(void *context, size_t begin, size_t end) {
    struct particles *particles = context;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double inverse_length = 1 / particles->box.length[d];
        const double *restrict x = particles->position[d];
        int32_t *restrict fraction = particles->fraction[d];
        for (size_t k = begin; k < end; k++)
            fraction[k] = box_fraction(x[k], inverse_length);
        for (size_t k = begin; k < end; k++)
            particles->kernel_place[k].fraction[d] = fraction[k];
    }
}

SIMD_CLONES static void update_precise_places(void *context, size_t begin, size_t end) {
    const struct particles *particles = context;
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = begin; k < end; k++)
            particles->precise_place[k].position[d] = particles->position[d][k];
}

void mf_particles_update_fractions(struct particles *particles) {
    mf_parallel_for(particles->count, particles->threads, update_fractions, particles);
    if (particles->precise_place)
        mf_parallel_for(particles->count, particles->threads, update_precise_places, particles);
}

static void label_places(void *context, size_t begin, size_t end) {
    const struct particles *particles = context;
    for (size_t k = begin; k < end; k++)
        particles->kernel_place[k].id = particles->id[k];
    if (particles->precise_place)
        for (size_t k = begin; k < end; k++)
            particles->precise_place[k].id = particles->id[k];
}

void mf_particles_label_places(struct particles *particles) {
    mf_parallel_for(particles->count, particles->threads, label_places, particles);
}

struct prediction {
    struct particles *particles;
    double ahead;
};

SIMD_CLONES static void update_motion(void *context, size_t begin, size_t end) {
    const struct prediction *prediction = context;
    const struct particles *particles = prediction->particles;
    struct particle_motion *restrict motion = particles->kernel_motion;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *restrict v = particles->velocity[d], *restrict force = particles->force[d];
        for (size_t k = begin; k < end; k++)
            motion[k].velocity[d] = (float)(v[k] + prediction->ahead * force[k]);
    }
    for (size_t k = begin; k < end; k++)
        motion[k].id = particles->id[k];
}

SIMD_CLONES static void update_precise_motion(void *context, size_t begin, size_t end) {
    const struct prediction *prediction = context;
    const struct particles *particles = prediction->particles;
    struct particle_precise_motion *restrict motion = particles->precise_motion;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *restrict v = particles->velocity[d], *restrict force = particles->force[d];
        for (size_t k = begin; k < end; k++)
            motion[k].velocity[d] = v[k] + prediction->ahead * force[k];
    }
    for (size_t k = begin; k < end; k++)
        motion[k].id = particles->id[k];
}

void mf_particles_update_motion(struct particles *particles, double ahead) {
    struct prediction prediction = {particles, ahead};
    mf_parallel_for(particles->count, particles->threads, update_motion, &prediction);
    if (particles->precise_motion)
        mf_parallel_for(particles->count, particles->threads, update_precise_motion, &prediction);
}

/// One array on its way into another order.
struct permutation {
    const uint32_t *order;
    const void *from;
    void *to;
};

static void permute_doubles(void *context, size_t begin, size_t end) {
    const struct permutation *p = context;
    const double *restrict from = p->from;
    double *restrict to = p->to;
    for (size_t k = begin; k < end; k++)
        to[k] = from[p->order[k]];
}

static void permute_words(void *context, size_t begin, size_t end) {
    const struct permutation *p = context;
    const uint32_t *restrict from = p->from;
    uint32_t *restrict to = p->to;
    for (size_t k = begin; k < end; k++)
        to[k] = from[p->order[k]];
}

static void permute_motions(void *context, size_t begin, size_t end) {
    const struct permutation *p = context;
    const struct particle_motion *restrict from = p->from;
    struct particle_motion *restrict to = p->to;
    for (size_t k = begin; k < end; k++)
        to[k] = from[p->order[k]];
}

static void permute_precise_motions(void *context, size_t begin, size_t end) {
    const struct permutation *p = context;
    const struct particle_precise_motion *restrict from = p->from;
    struct particle_precise_motion *restrict to = p->to;
    for (size_t k = begin; k < end; k++)
        to[k] = from[p->order[k]];
}

/// Permute *array into *spare, and exchange them.
#define PERMUTE(particles, array, spare, order, permute)                                           \
    do {                                                                                           \
        struct permutation permutation = {(order), (array), (spare)};                              \
        void *old = (array);                                                                       \
        mf_parallel_for((particles)->count, (particles)->threads, (permute), &permutation);        \
        (array) = (spare);                                                                         \
        (spare) = old;                                                                             \
    } while (0)

void mf_particles_permute(struct particles *particles, const uint32_t *order) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        PERMUTE(particles, particles->position[d], particles->spare, order, permute_doubles);
        PERMUTE(particles, particles->velocity[d], particles->spare, order, permute_doubles);
        PERMUTE(particles, particles->image[d], particles->spare_words, order, permute_words);
    }
    PERMUTE(particles, particles->id, particles->spare_words, order, permute_words);
    PERMUTE(particles, particles->kernel_motion, particles->spare_motion, order, permute_motions);
    if (particles->precise_motion)
        PERMUTE(particles, particles->precise_motion, particles->spare_precise_motion, order,
                permute_precise_motions);
}

void mf_particles_draw_velocities(struct particles *particles, double temperature, uint64_t seed) {
    const double scale = sqrt(temperature);
    for (size_t k = 0; k < particles->count; k++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(seed, RNG_VELOCITIES, particles->id[k], 0, 0), normal);
        for (int d = 0; d < particles->box.dimensions; d++)
            particles->velocity[d][k] = scale * normal[d];
    }
    mf_particles_remove_momentum(particles);
}

void mf_particles_remove_momentum(struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        double *v = particles->velocity[d], sum = 0;
        for (size_t k = 0; k < particles->count; k++)
            sum += v[k];
        const double mean = sum / (double)particles->count;
        for (size_t k = 0; k < particles->count; k++)
            v[k] -= mean;
    }
}

SIMD_CLONES static double square_velocities(const void *context, size_t begin, size_t end) {
    const struct particles *particles = context;
    double sum[8] = {0};
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *v = particles->velocity[d] + begin;
        const size_t count = end - begin;
        for (size_t k = 0; k + 8 <= count; k += 8)
            for (int lane = 0; lane < 8; lane++)
                sum[lane] += v[k + lane] * v[k + lane];
        for (size_t k = count / 8 * 8; k < count; k++)
            sum[0] += v[k] * v[k];
    }
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

double mf_particles_square_velocities(const struct particles *particles) {
    return mf_parallel_sum(particles->count, particles->threads, square_velocities, particles);
}

double mf_particles_temperature(const struct particles *particles) {
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

double mf_particles_largest_force(const struct particles *particles) {
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
