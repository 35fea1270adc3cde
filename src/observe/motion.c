// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/motion.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "base/statistics.h"
#include "observe/sample_blocks.h"
#include "system/orientation.h"

#include <math.h>
#include <string.h>

#define MEMBER(name) .offset = offsetof(struct motion_plan, name)
const struct field mf_motion_plan_fields[] = {
    {"every", FIELD_INTEGER, MEMBER(every), .initial = 5, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "interval between samples, in which velocities change little"},
    {"lags", FIELD_INTEGER, MEMBER(lags), .initial = 100, .minimum = 2, .maximum = 1e5,
     .unit = "samples", .help = "length of the window, at most a twentieth of the run"},
    {"origin_every", FIELD_INTEGER, MEMBER(origin_every), .initial = 10, .minimum = 1,
     .maximum = 1e5, .unit = "samples", .help = "interval between time origins"},
    FIELD_END,
};

/// Origins whose windows have ended by the sample number `last`.
static size_t complete_origins(const struct motion_plan *plan, size_t last) {
    const size_t lags = (size_t)plan->lags;
    return last < lags ? 0 : (last - lags) / (size_t)plan->origin_every + 1;
}

/// Without velocities, and for beads in a solvent, the momentum of the particles is not conserved.
static bool keeps_momentum(const struct simulation_setup *setup) {
    return simulation_has_velocities(setup) && setup->integrator->solvent_particles == NULL;
}

/// Number of the last sample.
static size_t last_sample(const struct motion *motion) {
    const size_t last_origin = motion->blocks * motion->each - 1;
    return last_origin * (size_t)motion->plan.origin_every + (size_t)motion->plan.lags;
}

static enum status allocate(struct motion *motion) {
    enum status status = STATUS_OK;
    // Velocities are tested once in a window.
    const size_t tested = motion->endless ? 0 : last_sample(motion) / (size_t)motion->plan.lags + 1;
    const size_t state = 2 * (size_t)motion->dimensions, curve = (size_t)motion->plan.lags + 1;
    motion->slots = (size_t)(motion->plan.lags / motion->plan.origin_every + 1);
    NEW_ARRAY(motion->now, state * motion->count);
    NEW_ARRAY(motion->origins, motion->slots * state * motion->count);
    NEW_ARRAY(motion->squares, motion->blocks * curve);
    NEW_ARRAY(motion->products, motion->blocks * curve);
    CHECK(mf_maxwell_init(&motion->maxwell, tested));
done:
    if (status != STATUS_OK)
        mf_motion_clear(motion);
    return status;
}

enum status mf_motion_init_points(struct motion *motion, const struct motion_plan *plan,
                                  const struct simulation *simulation, size_t count, int64_t begin,
                                  int64_t steps) {
    *motion = (struct motion){.plan = *plan,
                              .dimensions = simulation->setup.box.dimensions,
                              .count = count,
                              .time_step = simulation->setup.time_step,
                              .together = keeps_momentum(&simulation->setup),
                              .begin = begin};
    const size_t origins = complete_origins(plan, (size_t)(steps / plan->every));
    if (origins == 0)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "motion: %lld lags of %lld steps are longer than the %lld steps of the "
            "measurement; lower \"lags\", or raise \"samples\" of \"measure\"",
            (long long)plan->lags, (long long)plan->every, (long long)steps);
    // Blocks of the same size: the mean over them is the mean over their origins.
    motion->each = (origins + MOTION_MAX_BLOCKS - 1) / MOTION_MAX_BLOCKS;
    motion->blocks = origins / motion->each;
    return allocate(motion);
}

enum status mf_motion_init(struct motion *motion, const struct motion_plan *plan,
                           const struct simulation *simulation, int64_t begin, int64_t steps) {
    TRY(mf_motion_init_points(motion, plan, simulation, simulation->particles.count, begin, steps));
    motion->has_velocities = simulation_has_velocities(&simulation->setup);
    return STATUS_OK;
}

enum status mf_motion_init_endless(struct motion *motion, const struct motion_plan *plan,
                                   size_t count, double interval, bool has_velocities) {
    *motion = (struct motion){.plan = *plan,
                              .dimensions = 3,
                              .count = count,
                              .time_step = interval,
                              .has_velocities = has_velocities,
                              .blocks = MOTION_MAX_BLOCKS,
                              .each = 1,
                              .endless = true};
    return allocate(motion);
}

void mf_motion_clear(struct motion *motion) {
    mf_memory_free(motion->now);
    mf_memory_free(motion->origins);
    mf_memory_free(motion->squares);
    mf_memory_free(motion->products);
    mf_maxwell_clear(&motion->maxwell);
    mf_whole_molecules_clear(&motion->whole);
    *motion = (struct motion){0};
}

int64_t mf_motion_due(const struct motion *motion) {
    const int64_t sample = (int64_t)motion->samples;
    return sample > (int64_t)last_sample(motion) ? INT64_MAX
                                                 : motion->begin + sample * motion->plan.every;
}

// Sampling ----------------------------------------------------------------------------------------

/// Make positions or velocities, by id, those relative to the centre of mass.
static void subtract_mean(const struct particles *particles, double *values) {
    const double *mass = particles_masses(particles);
    const size_t count = particles->count;
    double sum = 0, all = 0;
    for (size_t k = 0; k < count; k++) {
        sum += mass ? mass[k] * values[particles->id[k]] : values[k];
        all += mass ? mass[k] : 1;
    }
    const double mean = sum / all;
    for (size_t k = 0; k < count; k++)
        values[k] -= mean;
}

/// Orientations by id, in the place of the second component of what will be polarities.
static double *gather_angles(struct motion *motion, const struct particles *particles) {
    double *angles = motion->now + 3 * motion->count;
    const struct orientation orientation = mf_orientation_of(particles);
    for (size_t k = 0; k < motion->count; k++)
        angles[particles->id[k]] = orientation.angle[k];
    return angles;
}

/// Unwrapped positions and velocities, by id, relative to those of the centre of mass where
/// momentum is conserved. Where it is not, the centre of mass diffuses, too, and its share stays.
static void gather(struct motion *motion, const struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    const struct integrator *integrator = simulation->setup.integrator;
    const size_t count = motion->count;
    for (int d = 0; d < motion->dimensions; d++) {
        double *x = motion->now + (size_t)d * count;
        double *v = motion->now + (size_t)(motion->dimensions + d) * count;
        for (size_t k = 0; k < count; k++) {
            const size_t id = particles->id[k];
            x[id] = particles->position[d][k] + particles->image[d][k] * particles->box.length[d];
            v[id] = particles->velocity[d][k];
        }
        if (motion->together) {
            subtract_mean(particles, x);
            subtract_mean(particles, v);
        }
    }
    double *angles = motion->polar ? gather_angles(motion, particles) : NULL;
    if (integrator->remove_correlated)
        integrator->remove_correlated(simulation, motion->now, angles);
    for (size_t k = 0; angles && k < count; k++)
        orientation_polarity(angles[k], angles - count + k, angles + k);
}

/// Two states of the particles, shape [dimensions, count] each.
struct states {
    const double *now, *then;
    int dimensions;
    size_t count;
};

enum { LANES = 8 };

static double sum_lanes(const double sum[LANES]) {
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/// What is summed over components: (a − b)² or a b. `squared` is constant where this is inlined.
static inline __attribute__((always_inline)) double term(double a, double b, bool squared) {
    return squared ? (a - b) * (a - b) : a * b;
}

static inline __attribute__((always_inline)) double
sum_terms(const struct states *states, size_t begin, size_t end, bool squared) {
    double sum[LANES] = {0};
    for (int d = 0; d < states->dimensions; d++) {
        const double *a = states->now + (size_t)d * states->count + begin;
        const double *b = states->then + (size_t)d * states->count + begin;
        const size_t count = end - begin;
        for (size_t k = 0; k + LANES <= count; k += LANES)
            for (int lane = 0; lane < LANES; lane++)
                sum[lane] += term(a[k + lane], b[k + lane], squared);
        for (size_t k = count / LANES * LANES; k < count; k++)
            sum[0] += term(a[k], b[k], squared);
    }
    return sum_lanes(sum);
}

SIMD_CLONES static double sum_squares(const void *context, size_t begin, size_t end) {
    return sum_terms(context, begin, end, true);
}

SIMD_CLONES static double sum_products(const void *context, size_t begin, size_t end) {
    return sum_terms(context, begin, end, false);
}

static void correlate(struct motion *motion, size_t origin, int threads) {
    const size_t lag = motion->samples - origin * (size_t)motion->plan.origin_every;
    const size_t half = (size_t)motion->dimensions * motion->count;
    const double *then = motion->origins + origin % motion->slots * 2 * half;
    const struct states positions = {motion->now, then, motion->dimensions, motion->count};
    const struct states velocities = {motion->now + half, then + half, motion->dimensions,
                                      motion->count};
    const size_t place = origin / motion->each * ((size_t)motion->plan.lags + 1) + lag;
    const double count = (double)motion->count;
    motion->squares[place] +=
        mf_parallel_sum(motion->count, threads, sum_squares, &positions) / count;
    motion->products[place] +=
        motion->has_velocities || motion->polar
            ? mf_parallel_sum(motion->count, threads, sum_products, &velocities) / count
            : NAN;
}

/// Make of every two blocks one, of twice the origins.
static void join_blocks(struct motion *motion) {
    const size_t curve = (size_t)motion->plan.lags + 1;
    mf_sample_blocks_join(motion->squares, motion->blocks, curve);
    mf_sample_blocks_join(motion->products, motion->blocks, curve);
    motion->each *= 2;
}

/// Let a window begin with the present sample, if one is to.
static void open_window(struct motion *motion) {
    const size_t every = (size_t)motion->plan.origin_every, origin = motion->samples / every;
    const size_t state = 2 * (size_t)motion->dimensions * motion->count;
    if (motion->samples % every != 0)
        return;
    if (motion->endless && origin == motion->blocks * motion->each)
        join_blocks(motion);
    if (origin < motion->blocks * motion->each)
        memcpy(motion->origins + origin % motion->slots * state, motion->now,
               state * sizeof *motion->now);
}

/// Add what stands in motion->now.
static void add_present(struct motion *motion, int threads) {
    const size_t every = (size_t)motion->plan.origin_every, lags = (size_t)motion->plan.lags;
    const size_t sample = motion->samples;
    open_window(motion);
    const size_t first = sample > lags ? (sample - lags + every - 1) / every : 0;
    const size_t all = motion->blocks * motion->each;
    for (size_t origin = first; origin < all && origin * every <= sample; origin++)
        correlate(motion, origin, threads);
    motion->samples++;
}

void mf_motion_sample(struct motion *motion, const struct simulation *simulation) {
    const struct simulation_setup *setup = &simulation->setup;
    gather(motion, simulation);
    if (setup->omega && motion->samples % (size_t)motion->plan.lags == 0)
        mf_maxwell_sample(&motion->maxwell, &simulation->particles, setup->temperature, setup->seed,
                          simulation->step);
    add_present(motion, simulation->particles.threads);
}

enum status mf_motion_see_molecules(struct motion *motion, const struct particles *particles) {
    if (particles->topology == NULL || motion->samples % (size_t)motion->plan.lags != 0)
        return STATUS_OK;
    if (motion->whole.topology == NULL)
        TRY(mf_whole_molecules_init(&motion->whole, particles->topology));
    motion->gyration[0] +=
        mf_whole_molecules_gyration(&motion->whole, particles) / (double)motion->count;
    motion->gyration[1]++;
    return STATUS_OK;
}

void mf_motion_add(struct motion *motion, const double *state, int threads) {
    memcpy(motion->now, state,
           2 * (size_t)motion->dimensions * motion->count * sizeof *motion->now);
    add_present(motion, threads);
}

size_t mf_motion_spans(struct motion *motion, struct memory_span *spans) {
    const size_t state = 2 * (size_t)motion->dimensions * motion->count * sizeof(double);
    const size_t curves = motion->blocks * ((size_t)motion->plan.lags + 1) * sizeof(double);
    size_t n = 0;
    spans[n++] = (struct memory_span){&motion->samples, sizeof motion->samples};
    spans[n++] = (struct memory_span){motion->origins, motion->slots * state};
    spans[n++] = (struct memory_span){motion->squares, curves};
    spans[n++] = (struct memory_span){motion->products, curves};
    spans[n++] = (struct memory_span){motion->gyration, sizeof motion->gyration};
    return n + mf_maxwell_spans(&motion->maxwell, spans + n);
}

size_t mf_motion_blocks(const struct motion *motion) {
    const size_t taken = motion->samples;
    const size_t blocks = taken ? complete_origins(&motion->plan, taken - 1) / motion->each : 0;
    return blocks < motion->blocks ? blocks : motion->blocks;
}
