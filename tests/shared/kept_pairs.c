// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/kept_pairs.h"

#include "shared/is_close.h"
#include "shared/testing.h"
#include "system/placement.h"

#include <math.h>

/// What the order of double-precision additions can change, relative to the largest partial sum.
static const double rounding = 1e-13;

/// Uniform random particles, of which no two are very close, sorted and listed. One `law` for all.
void kept_pairs_init(struct kept_pairs *kept, const struct box *box, size_t count,
                     double separation) {
    assert_ok(mf_particles_init(&kept->particles, box, count));
    assert_ok(mf_particles_keep_precise(&kept->particles));
    kept->particles.threads = 1;
    assert_ok(mf_placement_random(&kept->particles, separation, 5));
    mf_particles_draw_velocities(&kept->particles, PARTICLES_MAXWELL, kept->law.temperature, 6);
    assert_ok(mf_neighbours_init(&kept->neighbours, NEIGHBOURS_HALF, box, count,
                                 mf_pair_cutoff(&kept->law), 0.2));
    assert_ok(mf_neighbours_sort_and_build(&kept->neighbours, &kept->particles));
}

struct pair_law kept_pairs_law(const struct table *potential, const struct table *omega,
                               double time_step) {
    return (struct pair_law){.potential = potential,
                             .omega = omega,
                             .temperature = 1.3,
                             .time_step = time_step,
                             .seed = 0x123456789ABCDEF};
}

void kept_pairs_use(struct kept_pairs *kept, const struct integrator *integrator) {
    assert_ok(mf_friction_init(&kept->friction, kept->law.omega, kept->law.time_step,
                               kept->law.temperature, integrator->friction));
}

/// The force pass of a step.
void kept_pairs_keep(struct kept_pairs *kept, uint64_t step) {
    struct pair_law law = kept->law;
    law.friction = &kept->friction;
    assert_ok(mf_friction_reserve(&kept->friction, &kept->neighbours));
    mf_pair_forces(&law, &kept->particles, &kept->neighbours, step, PAIR_FORCES, NULL);
}

size_t kept_pairs_count(const struct friction *friction) {
    size_t pairs = 0;
    for (int p = 0; p < friction->parts; p++)
        pairs += friction->end[p] - friction->begin[p];
    return pairs;
}

void kept_pairs_clear(struct kept_pairs *kept) {
    mf_particles_clear(&kept->particles);
    mf_neighbours_clear(&kept->neighbours);
    mf_friction_clear(&kept->friction);
    *kept = (struct kept_pairs){0};
}

/// Σ v along each axis, and Σ |v| that its rounding is relative to.
void kept_pairs_momentum(const struct particles *particles, double sum[3], double *size) {
    *size = 0;
    for (int d = 0; d < 3; d++) {
        sum[d] = 0;
        for (size_t k = 0; k < particles->count; k++) {
            sum[d] += particles->velocity[d][k];
            *size += fabs(particles->velocity[d][k]);
        }
    }
}

void kept_pairs_assert_momentum(const struct particles *particles, const double before[3]) {
    double after[3], size;
    kept_pairs_momentum(particles, after, &size);
    for (int d = 0; d < 3; d++)
        assert_close(after[d], before[d], rounding * size);
}
