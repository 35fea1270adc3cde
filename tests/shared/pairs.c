// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/pairs.h"

#include "base/rng.h"
#include "curves/formula.h"
#include "curves/sampled.h"
#include "shared/testing.h"
#include "system/placement.h"

#include <math.h>

struct pairs_tables pairs_tables;

static void make_sampled(struct curve *curve) {
    enum { POINTS = 60 };
    double r[POINTS], phi[POINTS];
    for (int k = 0; k < POINTS; k++) {
        r[k] = 0.4 + 1.2 * k / (POINTS - 1);
        phi[k] = 5 * exp(-4 * r[k]) * cos(6 * r[k]) * (1.6 - r[k]);
    }
    assert_ok(mf_sampled_create(curve, r, phi, POINTS));
}

int pairs_begin(void **state) {
    (void)state;
    struct curve curve;
    assert_ok(mf_curve_create(&curve, &mf_formula_soft_repulsion));
    assert_ok(mf_table_init_potential(&pairs_tables.soft, &curve));
    mf_curve_clear(&curve);
    assert_ok(mf_curve_create(&curve, &mf_formula_lennard_jones));
    assert_ok(mf_table_init_potential(&pairs_tables.lennard_jones, &curve));
    mf_curve_clear(&curve);
    assert_ok(mf_curve_create(&curve, &mf_formula_gaussian));
    ((struct formula_gaussian_parameters *)curve.parameters)->cutoff = 2;
    assert_ok(mf_table_init_potential(&pairs_tables.gaussian, &curve));
    mf_curve_clear(&curve);
    make_sampled(&curve);
    assert_ok(mf_table_init_potential(&pairs_tables.sampled, &curve));
    mf_curve_clear(&curve);
    assert_ok(mf_curve_create(&curve, &mf_formula_power_omega));
    assert_ok(mf_table_init_omega(&pairs_tables.omega, &curve));
    struct formula_power_omega_parameters *omega = curve.parameters;
    *omega = (struct formula_power_omega_parameters){
        .sigma = 2.589, .exponent = 1, .inner_cutoff = 0.596, .cutoff = 1.72};
    assert_ok(mf_table_init_omega(&pairs_tables.thesis_omega, &curve));
    mf_curve_clear(&curve);
    return 0;
}

int pairs_end(void **state) {
    (void)state;
    mf_table_clear(&pairs_tables.soft);
    mf_table_clear(&pairs_tables.lennard_jones);
    mf_table_clear(&pairs_tables.gaussian);
    mf_table_clear(&pairs_tables.sampled);
    mf_table_clear(&pairs_tables.omega);
    mf_table_clear(&pairs_tables.thesis_omega);
    return 0;
}

struct pair_law pairs_law(const struct table *potential, const struct table *omega) {
    return (struct pair_law){.potential = potential,
                             .omega = omega,
                             .temperature = 1.3,
                             .time_step = 0.02,
                             .seed = 0x123456789ABCDEF};
}

/// Uniform random positions, within `radius` of the corner on all sides of it if that is above 0.
static void place_random(struct particles *particles, double radius, uint64_t seed) {
    struct rng_sequence sequence = mf_rng_sequence_begin(seed, RNG_PLACEMENT, 0, 0);
    for (size_t k = 0; k < particles->count; k++)
        for (int d = 0; d < particles->box.dimensions; d++) {
            const double width = radius > 0 ? 2 * radius : particles->box.length[d];
            particles->position[d][k] = width * (mf_rng_sequence_uniform(&sequence) - 0.5);
        }
    mf_particles_wrap(particles);
}

void pairs_place(struct particles *particles, const struct pairs_system *system) {
    assert_ok(mf_particles_init(particles, &system->box, system->count));
    assert_ok(mf_particles_keep_precise(particles));
    if (system->arrangement == PAIRS_LATTICE)
        mf_placement_lattice(particles, 0.1, 5);
    else
        place_random(particles, system->arrangement == PAIRS_CLUSTERED ? 0.6 : 0, 5);
    mf_particles_draw_velocities(particles, PARTICLES_MAXWELL, 1.3, 6);
}

void pairs_make(struct particles *particles, struct neighbours *neighbours,
                const struct pairs_system *system, const struct pair_law *law) {
    pairs_place(particles, system);
    assert_ok(mf_neighbours_init(neighbours, NEIGHBOURS_HALF, &system->box, system->count,
                                 mf_pair_cutoff(law), system->skin));
    assert_ok(mf_neighbours_sort_and_build(neighbours, particles));
    mf_particles_update_motion(particles, 0);
}
