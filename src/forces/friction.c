// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/friction.h"

#include "base/lanes.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"

#include <math.h>

enum status mf_friction_init(struct friction *friction, const struct table *table, double time_step,
                             double temperature, const struct friction_method *method) {
    *friction =
        (struct friction){.method = method,
                          .kick = method->square ? sqrt(method->square(time_step, temperature)) : 0,
                          .bound = method->bound};
    mf_normal_table_init(&friction->normal);
    const int rows = (TABLE_INTERVALS + 1) * table->curves;
    TRY_ARRAY(friction->precise, rows);
    TRY_ARRAY(friction->single, rows);
    for (int k = 0; k < rows; k++) {
        if (k % (TABLE_INTERVALS + 1) == TABLE_INTERVALS) // beyond the cutoff is nothing
            continue;
        const double *omega = table->coefficient + 2 * k;
        const double root = sqrt(method->damping(omega[0], time_step));
        const double next = sqrt(method->damping(omega[0] + omega[1], time_step));
        friction->precise[k][0] = root;
        friction->precise[k][1] = next - root;
        for (int n = 0; n < 2; n++)
            friction->single[k][n] = (float)friction->precise[k][n];
    }
    return STATUS_OK;
}

enum status mf_friction_reserve_work(struct friction *friction, size_t count) {
    for (int n = 0; n < FRICTION_WORK; n++)
        if (friction->work[n] == NULL)
            TRY_ARRAY(friction->work[n], count);
    return STATUS_OK;
}

void mf_friction_clear(struct friction *friction) {
    mf_memory_free(friction->precise);
    mf_memory_free(friction->single);
    mf_memory_free(friction->direction);
    mf_memory_free(friction->pair);
    for (int n = 0; n < FRICTION_WORK; n++)
        mf_memory_free(friction->work[n]);
    *friction = (struct friction){0};
}

enum status mf_friction_reserve(struct friction *friction, const struct neighbours *neighbours) {
    friction->parts = neighbours->parts;
    for (int p = 0; p < neighbours->parts; p++)
        friction->begin[p] = friction->end[p] = neighbours->part[p].begin;
    if (neighbours->list_capacity <= friction->capacity)
        return STATUS_OK;
    mf_memory_free(friction->direction);
    mf_memory_free(friction->pair);
    friction->capacity = 0;
    // Most of the room is never touched, and so takes no memory.
    friction->direction =
        mf_memory_uncleared(neighbours->list_capacity, sizeof *friction->direction);
    friction->pair = mf_memory_uncleared(neighbours->list_capacity, sizeof *friction->pair);
    if (friction->direction == NULL || friction->pair == NULL)
        return STATUS_NO_MEMORY;
    friction->capacity = neighbours->list_capacity;
    return STATUS_OK;
}

static inline double sum_of(lanes_double4 a) {
    return (a[0] + a[1]) + a[2];
}

static void load_velocities(void *context, size_t begin, size_t end) {
    struct particles *particles = context;
    for (size_t k = begin; k < end; k++)
        for (int d = 0; d < 4; d++)
            particles->kernel_force[k][d] = d < 3 ? particles->velocity[d][k] : 0;
}

SIMD_CLONES static void store_velocities(void *context, size_t begin, size_t end) {
    struct particles *particles = context;
    const double(*v)[4] = (const double(*)[4])particles->kernel_force;
    double *restrict x = particles->velocity[0], *restrict y = particles->velocity[1];
    double *restrict z = particles->velocity[2];
    for (size_t k = begin; k < end; k++) {
        x[k] = v[k][0];
        y[k] = v[k][1];
        z[k] = v[k][2];
    }
}

/// Without masses they are 1.
static inline void change_pair(const float direction[4], const struct friction_pair *pair,
                               const double *mass, lanes_double4 *v) {
    const lanes_double4 e = lanes_load_double4(direction);
    const double u = sum_of(e * (v[pair->i] - v[pair->j]));
    const lanes_double4 change = (pair->kick - pair->damping * u) * e;
    v[pair->i] += mass ? change / mass[pair->i] : change;
    v[pair->j] -= mass ? change / mass[pair->j] : change;
}

enum { SWEEP_BLOCK = 1024, SWEEP_STRIDE = 633 };

/// The pair of `count` that a sweep comes to as number n.
static inline size_t place_of(size_t n, size_t count) {
    const size_t block = n / SWEEP_BLOCK * SWEEP_BLOCK;
    return block + SWEEP_BLOCK <= count ? block + (n - block) * SWEEP_STRIDE % SWEEP_BLOCK : n;
}

/// Pairs come sorted by particle, where each waits for the velocity that the last one changed. So
/// they are taken in strides of the golden section of a block: neighbours in time share no
/// particle, and a processor overlaps them. Measured on Zen 5 for the thesis's scene, 35 pairs a
/// particle: blocks of 256, 1024 and 2048 make 1058, 1104 and 1070 steps/s.
/// The pairs of the block after the next, and velocities of those of the next, are called for
/// meanwhile: out of order a processor does not foresee them, and from 10^5 particles on it waited
/// for memory for two thirds of a sweep.
static inline void sweep_in_strides(const float (*direction)[4], const struct friction_pair *pair,
                                    size_t count, const double *mass, lanes_double4 *v) {
    const size_t whole = count / SWEEP_BLOCK * SWEEP_BLOCK;
    for (size_t block = 0; block < whole; block += SWEEP_BLOCK)
        for (size_t n = 0; n < SWEEP_BLOCK; n++) {
            const size_t k = block + n * SWEEP_STRIDE % SWEEP_BLOCK;
            const size_t next = block + SWEEP_BLOCK + n, later = next + SWEEP_BLOCK;
            __builtin_prefetch(direction + later);
            __builtin_prefetch(pair + later);
            if (next < whole)
                __builtin_prefetch(v + pair[next].j);
            change_pair(direction[k], &pair[k], mass, v);
        }
    for (size_t k = whole; k < count; k++)
        change_pair(direction[k], &pair[k], mass, v);
}

SIMD_CLONES static void sweep_pairs(const float (*direction)[4], const struct friction_pair *pair,
                                    size_t count, const double *mass, lanes_double4 *v) {
    if (mass)
        sweep_in_strides(direction, pair, count, mass, v);
    else
        sweep_in_strides(direction, pair, count, NULL, v);
}

static inline double distance_of(const struct particles *particles, int32_t i, int32_t j) {
    double square = 0;
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double dx = box_nearest(particles->position[d][i] - particles->position[d][j],
                                      particles->box.length[d]);
        square += dx * dx;
    }
    return sqrt(square);
}

static inline void sweep_and_add(const struct friction *friction, const struct particles *particles,
                                 int p, const double *mass, lanes_double4 *v,
                                 double transfer[3][3]) {
    const size_t begin = friction->begin[p], count = friction->end[p] - begin;
    for (size_t n = 0; n < count; n++) {
        const size_t k = begin + place_of(n, count);
        const struct friction_pair *pair = &friction->pair[k];
        const lanes_double4 before = v[pair->i];
        change_pair(friction->direction[k], pair, mass, v);
        const lanes_double4 impulse = (v[pair->i] - before) * (mass ? mass[pair->i] : 1);
        transfer_add(transfer, distance_of(particles, pair->i, pair->j), friction->direction[k],
                     (double[]){impulse[0], impulse[1], impulse[2]});
    }
}

/// The same sweep, with the same bits, which adds up what the pairs exchange. As above, what has no
/// masses has instructions of its own: with a choice between two the last bits would be others.
SIMD_CLONES static void sweep_and_report(const struct friction *friction,
                                         const struct particles *particles, int p,
                                         const double *mass, lanes_double4 *v,
                                         double transfer[3][3]) {
    if (mass)
        sweep_and_add(friction, particles, p, mass, v, transfer);
    else
        sweep_and_add(friction, particles, p, NULL, v, transfer);
}

void mf_friction_load_velocities(struct particles *particles) {
    mf_parallel_for(particles->count, particles->threads, load_velocities, particles);
}

void mf_friction_store_velocities(struct particles *particles) {
    mf_parallel_for(particles->count, particles->threads, store_velocities, particles);
}

struct sweep {
    const struct friction *friction;
    const struct particles *particles;
    struct transfer *transfer; ///< NULL: nobody asks
};

static void sweep_part(void *context, int part) {
    const struct sweep *sweep = context;
    const struct friction *friction = sweep->friction;
    lanes_double4 *v = (lanes_double4 *)sweep->particles->kernel_force;
    const double *mass = particles_masses(sweep->particles);
    const size_t begin = friction->begin[part];
    if (sweep->transfer)
        sweep_and_report(friction, sweep->particles, part, mass, v, sweep->transfer->part[part]);
    else
        sweep_pairs((const float(*)[4])friction->direction + begin, friction->pair + begin,
                    friction->end[part] - begin, mass, v);
}

/// Damping and kick of a pair of unit masses become those of its own. With x = 1 − 2 d, by which u
/// decays, and 1/μ = 1/m_i + 1/m_j it is x' = x^(1/2μ); the impulse is then
///   μ (1 − x') (−u) + sqrt(μ k_B T (1 − x'²)) ζ.
SIMD_CLONES static void weigh_pairs(struct friction_pair *pair, size_t count, const double *mass) {
    static const double min = 1e-30; // of 1 − x²: pairs at the end of ω
    for (size_t k = 0; k < count; k++) {
        const double reduced = 1 / (1 / mass[pair[k].i] + 1 / mass[pair[k].j]);
        const double x = 1 - 2 * (double)pair[k].damping;
        const double own = x > 0 ? exp(log(x) / (2 * reduced)) : 0;
        pair[k].damping = (float)(reduced * (1 - own));
        pair[k].kick *= (float)sqrt(2 * reduced * (1 - own * own) / fmax(1 - x * x, min));
    }
}

struct weighing {
    struct friction *friction;
    const double *mass;
};

static void weigh_part(void *context, int p) {
    const struct weighing *of = context;
    const struct friction *friction = of->friction;
    weigh_pairs(friction->pair + friction->begin[p], friction->end[p] - friction->begin[p],
                of->mass);
}

void mf_friction_weigh(struct friction *friction, const struct particles *particles) {
    struct weighing of = {friction, particles_masses(particles)};
    if (of.mass)
        mf_parallel_parts(friction->parts, particles->threads, weigh_part, &of);
}

void mf_friction_sweep(const struct friction *friction, struct particles *particles,
                       struct transfer *transfer) {
    struct sweep sweep = {friction, particles, transfer};
    mf_friction_load_velocities(particles);
    mf_parallel_ring(friction->parts, particles->threads, sweep_part, &sweep);
    mf_transfer_collect(transfer, friction->parts, 1);
    mf_friction_store_velocities(particles);
}

static inline void apply_pair(const float direction[4], const struct friction_pair *pair,
                              const lanes_double4 *from, lanes_double4 *to, double kicks) {
    const lanes_double4 e = lanes_load_double4(direction);
    const double u = sum_of(e * (from[pair->i] - from[pair->j]));
    const lanes_double4 change = (kicks * pair->kick - pair->damping * u) * e;
    to[pair->i] += change;
    to[pair->j] -= change;
}

SIMD_CLONES static void apply_pairs(const float (*direction)[4], const struct friction_pair *pair,
                                    size_t count, const lanes_double4 *from, lanes_double4 *to,
                                    double kicks) {
    for (size_t k = 0; k < count; k++)
        apply_pair(direction[k], &pair[k], from, to, kicks);
}

struct application {
    const struct friction *friction;
    const double (*from)[4];
    double (*to)[4];
    bool kicks;
};

static void apply_part(void *context, int part) {
    const struct application *a = context;
    const struct friction *friction = a->friction;
    const size_t begin = friction->begin[part];
    apply_pairs((const float(*)[4])friction->direction + begin, friction->pair + begin,
                friction->end[part] - begin, (const lanes_double4 *)a->from, (lanes_double4 *)a->to,
                a->kicks);
}

void mf_friction_apply(const struct friction *friction, const struct particles *particles,
                       const double (*from)[4], double (*to)[4], bool kicks) {
    struct application application = {friction, from, to, kicks};
    memset(to, 0, particles->count * sizeof *to);
    mf_parallel_ring(friction->parts, particles->threads, apply_part, &application);
}

struct addition {
    struct particles *particles;
    double *const *source;
    double scale;
    double (*from)[4], (*to)[4];
};

static void scale_source(void *context, size_t begin, size_t end) {
    const struct addition *a = context;
    for (size_t k = begin; k < end; k++)
        for (int d = 0; d < 3; d++)
            a->from[k][d] = a->scale * a->source[d][k];
}

static void add_to_forces(void *context, size_t begin, size_t end) {
    const struct addition *a = context;
    for (int d = 0; d < a->particles->box.dimensions; d++)
        for (size_t k = begin; k < end; k++)
            a->particles->force[d][k] += a->to[k][d];
}

enum status mf_friction_add_to_forces(struct friction *friction, struct particles *particles,
                                      double *const source[3], double scale, bool kicks) {
    TRY(mf_friction_reserve_work(friction, particles->count));
    struct addition addition = {particles, source, scale, friction->work[0], friction->work[1]};
    mf_parallel_for(particles->count, particles->threads, scale_source, &addition);
    mf_friction_apply(friction, particles, (const double(*)[4])addition.from, addition.to, kicks);
    mf_parallel_for(particles->count, particles->threads, add_to_forces, &addition);
    return STATUS_OK;
}
