// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/particles.h"

#include "base/parallel.h"
#include "base/simd.h"

#include <stdlib.h>

/// What becomes of an array.
enum {
    SORTED = 1,  ///< permuted with the particles
    SAVED = 2,   ///< kept by a checkpoint
    PRECISE = 4, ///< of the kernels in double precision: there if they are asked for
    JOINED = 8,  ///< of molecules: likewise
    MOTION = 16, ///< of mf_particles_update_motion: until then it takes no memory and is not sorted
};

/// An array of the struct: where its pointers are, how many for the axes, the size of an element.
struct array {
    size_t offset;
    int axes;
    size_t size;
    int treatment;
    size_t padding; ///< elements more
};

#define ARRAY(name) offsetof(struct particles, name), 1, sizeof *((struct particles *)NULL)->name
#define AXES(name) offsetof(struct particles, name), 3, sizeof *((struct particles *)NULL)->name[0]
static const struct array arrays[] = {
    {AXES(position), SORTED | SAVED, 0},
    {AXES(velocity), SORTED | SAVED, 0},
    {AXES(force), SAVED, 0}, // about to be replaced when the particles are sorted
    {AXES(image), SORTED | SAVED, 0},
    {AXES(fraction), 0, PARTICLES_PADDING},
    {ARRAY(id), SORTED | SAVED, 0},
    {ARRAY(kernel_place), 0, 0},
    {ARRAY(kernel_motion), SORTED | MOTION, 0},
    {ARRAY(kernel_force), 0, 0},
    {ARRAY(precise_place), PRECISE, 0},
    {ARRAY(precise_motion), PRECISE | SORTED | MOTION, 0},
    {ARRAY(spare), 0, 0},
    {offsetof(struct particles, spare_words), 1, sizeof(uint32_t), 0, 0},
    {ARRAY(spare_motion), MOTION, 0},
    {ARRAY(spare_precise_motion), PRECISE | MOTION, 0},
    {ARRAY(place), JOINED, 0},
};
enum { ARRAYS = sizeof arrays / sizeof *arrays };

/// The pointers are of many types: read and written as bytes.
static void *array_of(const struct particles *particles, const struct array *array, int axis) {
    void *pointer;
    memcpy(&pointer, (const char *)particles + array->offset + (size_t)axis * sizeof pointer,
           sizeof pointer);
    return pointer;
}

static void set_array(struct particles *particles, const struct array *array, int axis,
                      void *pointer) {
    memcpy((char *)particles + array->offset + (size_t)axis * sizeof pointer, &pointer,
           sizeof pointer);
}

/// The arrays that are asked for by `wanted`: PRECISE, JOINED, or 0 for those always there.
static enum status allocate(struct particles *particles, int wanted) {
    for (int k = 0; k < ARRAYS; k++)
        for (int axis = 0; axis < arrays[k].axes; axis++) {
            if ((arrays[k].treatment & (PRECISE | JOINED)) != wanted)
                continue;
            const size_t count = particles->count + arrays[k].padding;
            void *memory = arrays[k].treatment & MOTION ? mf_memory_uncleared(count, arrays[k].size)
                                                        : mf_memory_zeroed(count, arrays[k].size);
            if (memory == NULL)
                return STATUS_NO_MEMORY;
            set_array(particles, &arrays[k], axis, memory);
        }
    return STATUS_OK;
}

enum status mf_particles_init(struct particles *particles, const struct box *box, size_t count) {
    *particles = (struct particles){.count = count, .box = *box, .threads = 1};
    const enum status status = allocate(particles, 0);
    if (status != STATUS_OK)
        mf_particles_clear(particles);
    else
        for (size_t k = 0; k < count; k++)
            particles->id[k] = (uint32_t)k;
    return status;
}

enum status mf_particles_keep_precise(struct particles *particles) {
    return allocate(particles, PRECISE);
}

enum status mf_particles_join(struct particles *particles, const struct topology *topology) {
    if (topology == particles->topology || topology == NULL)
        return STATUS_OK;
    particles->topology = topology;
    return allocate(particles, JOINED);
}

void mf_particles_clear(struct particles *particles) {
    for (int k = 0; k < ARRAYS; k++)
        for (int axis = 0; axis < arrays[k].axes; axis++)
            mf_memory_free(array_of(particles, &arrays[k], axis));
    for (int k = 0; k < particles->attributes; k++)
        for (int c = 0; c < particles->attribute[k].components; c++)
            mf_memory_free(particles->attribute[k].value[c]);
    *particles = (struct particles){0};
}

static size_t size_of(const struct particles_attribute *attribute) {
    return attribute->type == PARTICLES_DOUBLE ? sizeof(double) : sizeof(uint32_t);
}

enum status mf_particles_add_attribute(struct particles *particles,
                                       const struct particles_attribute *attribute, int *number) {
    if (particles->attributes == PARTICLES_MAX_ATTRIBUTES)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: particles have at most %d attributes",
                              attribute->name, PARTICLES_MAX_ATTRIBUTES);
    *number = particles->attributes++;
    struct particles_attribute *own = &particles->attribute[*number];
    *own = *attribute;
    for (int c = 0; c < PARTICLES_MAX_COMPONENTS; c++)
        own->value[c] = NULL;
    for (int c = 0; c < own->components; c++) {
        own->value[c] = mf_memory_zeroed(particles->count, size_of(own));
        if (own->value[c] == NULL)
            return STATUS_NO_MEMORY;
    }
    return STATUS_OK;
}

const double *mf_particles_numbers(const struct particles *particles, const char *name) {
    for (int k = 0; k < particles->attributes; k++) {
        const struct particles_attribute *attribute = &particles->attribute[k];
        if (attribute->type == PARTICLES_DOUBLE && attribute->components == 1 &&
            strcmp(attribute->name, name) == 0)
            return attribute->value[0];
    }
    return NULL;
}

size_t mf_particles_spans(struct particles *particles, struct memory_span *spans) {
    size_t n = 0;
    for (int k = 0; k < ARRAYS; k++)
        for (int axis = 0; axis < arrays[k].axes; axis++)
            if ((arrays[k].treatment & SAVED) &&
                (arrays[k].axes == 1 || axis < particles->box.dimensions))
                spans[n++] = (struct memory_span){array_of(particles, &arrays[k], axis),
                                                  particles->count * arrays[k].size};
    for (int k = 0; k < particles->attributes; k++)
        for (int c = 0; c < particles->attribute[k].components; c++)
            spans[n++] = (struct memory_span){particles->attribute[k].value[c],
                                              particles->count * size_of(&particles->attribute[k])};
    return n;
}

double mf_particles_density(const struct particles *particles) {
    return (double)particles->count / mf_box_volume(&particles->box);
}

/// Boxes beyond which a fraction of the box is none (box_fraction), and their number no integer.
static const double reach = 0x1p18;

/// How many coordinates are beyond reach, or NaN: these stay as they are.
SIMD_CLONES static double wrap(const void *context, size_t begin, size_t end) {
    const struct particles *particles = context;
    int lost = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double length = particles->box.length[d];
        double *restrict x = particles->position[d];
        int32_t *restrict image = particles->image[d];
        for (size_t k = begin; k < end; k++) {
            const double away = floor(x[k] / length);
            const bool within = fabs(away) <= reach;
            const double boxes = within ? away : 0;
            const double inside = x[k] - boxes * length;
            // A tiny negative x rounds to exactly `length`: that is the next box's corner.
            const double carry = within && inside >= length ? 1 : 0;
            x[k] = inside - carry * length;
            image[k] += (int32_t)(boxes + carry);
            lost += !within;
        }
    }
    return lost;
}

bool mf_particles_wrap(struct particles *particles) {
    return mf_parallel_sum(particles->count, particles->threads, wrap, particles) == 0;
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
    if (particles->place)
        for (size_t k = begin; k < end; k++)
            particles->place[particles->id[k]] = (uint32_t)k;
}

void mf_particles_label_places(struct particles *particles) {
    particles->orders++;
    mf_parallel_for(particles->count, particles->threads, label_places, particles);
}

struct settling {
    struct particles *particles;
    double *const *copy;
};

static void settle(void *context, size_t begin, size_t end) {
    const struct settling *settling = context;
    struct particles *particles = settling->particles;
    update_fractions(particles, begin, end);
    if (particles->precise_place)
        update_precise_places(particles, begin, end);
    label_places(particles, begin, end);
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(settling->copy[d] + begin, particles->position[d] + begin,
               (end - begin) * sizeof *settling->copy[d]);
}

void mf_particles_settle(struct particles *particles, double *const copy[3]) {
    struct settling settling = {particles, copy};
    particles->orders++;
    mf_parallel_for(particles->count, particles->threads, settle, &settling);
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
    particles->has_motion = true;
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

/// Permute an array into the spare one of its elements' size, and exchange them.
static void *permute(struct particles *particles, void *array, size_t size, const uint32_t *order) {
    struct permutation permutation = {order, array, NULL};
    switch (size) {
    case sizeof(uint32_t):
        permutation.to = particles->spare_words;
        particles->spare_words = array;
        mf_parallel_for(particles->count, particles->threads, permute_words, &permutation);
        break;
    case sizeof(double):
        permutation.to = particles->spare;
        particles->spare = array;
        mf_parallel_for(particles->count, particles->threads, permute_doubles, &permutation);
        break;
    case sizeof(struct particle_motion):
        permutation.to = particles->spare_motion;
        particles->spare_motion = array;
        mf_parallel_for(particles->count, particles->threads, permute_motions, &permutation);
        break;
    case sizeof(struct particle_precise_motion):
        permutation.to = particles->spare_precise_motion;
        particles->spare_precise_motion = array;
        mf_parallel_for(particles->count, particles->threads, permute_precise_motions,
                        &permutation);
        break;
    }
    return permutation.to;
}

/// Whether an array is there and has something to be sorted.
static bool is_sorted(const struct particles *particles, const struct array *array) {
    return (array->treatment & SORTED) && (particles->has_motion || !(array->treatment & MOTION)) &&
           array_of(particles, array, 0) != NULL;
}

void mf_particles_permute(struct particles *particles, const uint32_t *order) {
    for (int k = 0; k < ARRAYS; k++)
        for (int axis = 0; axis < arrays[k].axes && is_sorted(particles, &arrays[k]); axis++)
            if (arrays[k].axes == 1 || axis < particles->box.dimensions)
                set_array(particles, &arrays[k], axis,
                          permute(particles, array_of(particles, &arrays[k], axis), arrays[k].size,
                                  order));
    for (int k = 0; k < particles->attributes; k++)
        for (int c = 0; c < particles->attribute[k].components; c++) {
            void **value = &particles->attribute[k].value[c];
            *value = permute(particles, *value, size_of(&particles->attribute[k]), order);
        }
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
