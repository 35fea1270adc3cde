// SPDX-License-Identifier: GPL-3.0-or-later
//
// What holds for the forces of any pair law: they depend on no order, follow seed and step, and are
// the gradient of their energy.
#include "base/simd.h"
#include "forces/pair.h"

#include "base/memory.h"
#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/pairs.h"
#include "shared/testing.h"
#include "shared/variants.h"

/// What the order of double-precision additions can change, relative to the largest partial sum.
static const double rounding = 1e-13;

static struct variant variants[VARIANTS_MAX];
static int variant_count;

static int begin(void **state) {
    variant_count = variants_find(variants);
    return pairs_begin(state);
}

/// Forces by id, in double precision.
static double *forces_by_id(const struct particles *particles) {
    double *forces = mf_memory_zeroed(3 * particles->count, sizeof *forces);
    assert_non_null(forces);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            forces[3 * particles->id[k] + (size_t)d] = particles->force[d][k];
    return forces;
}

/// Forces by id of a system whose arrays were shuffled before the sort, with another skin.
static double *shuffled_forces(const struct pairs_system *system, const struct pair_law *law,
                               uint64_t shuffle, double skin) {
    struct particles particles;
    struct neighbours neighbours;
    pairs_place(&particles, system);
    uint32_t *order = mf_memory_zeroed(system->count, sizeof *order);
    assert_non_null(order);
    struct rng_sequence sequence = mf_rng_sequence_begin(shuffle, RNG_SELECTION, 0, 0);
    for (uint32_t k = 0; k < system->count; k++) {
        const uint32_t other = shuffle ? mf_rng_sequence_below(&sequence, k + 1) : k;
        order[k] = order[other];
        order[other] = k;
    }
    mf_particles_permute(&particles, order);
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &system->box, system->count,
                                 mf_pair_cutoff(law), skin));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    mf_particles_update_motion(&particles, 0);
    mf_pair_forces(law, &particles, &neighbours, 3, PAIR_FORCES, NULL);
    double *forces = forces_by_id(&particles);
    mf_memory_free(order);
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
    return forces;
}

/// The arithmetic of a pair is symmetric, so only the order of the double additions is left.
static void test_pair_forces_do_not_depend_on_order_or_skin_when_ids_are_the_same(void **state) {
    (void)state;
    const struct pairs_system system = {{3, {5.1, 4.6, 6.3}}, 443, PAIRS_RANDOM, 0.25};
    struct pair_law law = pairs_law(&pairs_tables.soft, &pairs_tables.thesis_omega);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        law.precision = variants[v].precision;
        double *first = shuffled_forces(&system, &law, 0, 0.25);
        for (uint64_t shuffle = 1; shuffle < 5; shuffle++) {
            double *again = shuffled_forces(&system, &law, shuffle, 0.1 * (double)shuffle);
            for (size_t k = 0; k < 3 * system.count; k++)
                // Partial sums on a particle stay below some hundreds.
                assert_close(again[k], first[k], 1e3 * rounding);
            mf_memory_free(again);
        }
        mf_memory_free(first);
    }
}

static void test_pair_noise_changes_when_seed_or_step_changes(void **state) {
    (void)state;
    const struct pairs_system system = {{3, {4, 4, 4}}, 50, PAIRS_RANDOM, 0.25};
    struct pair_law law = pairs_law(NULL, &pairs_tables.omega);
    struct particles particles;
    struct neighbours neighbours;
    pairs_make(&particles, &neighbours, &system, &law);
    mf_pair_forces(&law, &particles, &neighbours, 3, PAIR_FORCES, NULL);
    const double first = particles.force[0][0];
    mf_pair_forces(&law, &particles, &neighbours, 3, PAIR_FORCES, NULL);
    assert_identical(particles.force[0][0], first);
    mf_pair_forces(&law, &particles, &neighbours, 3 + (UINT64_C(1) << 32), PAIR_FORCES, NULL);
    assert_true(fabs(particles.force[0][0] - first) > 1e-3);
    law.seed += UINT64_C(1) << 32;
    mf_pair_forces(&law, &particles, &neighbours, 3, PAIR_FORCES, NULL);
    assert_true(fabs(particles.force[0][0] - first) > 1e-3);
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

/// Slope against central differences of the value, from table and kernel alike.
static void check_gradient(const struct table *potential, double first) {
    // The third derivative is bounded by some 1e5 k_B T/λ³ in the range looked at, so the error of
    // the difference is below 1e-5; the C² spline's kinks add less.
    const double h = 1e-5, tolerance = 1e-4;
    for (double r = first; r < potential->cutoff - 0.01; r += 0.0037) {
        double low, high, slope;
        mf_table_evaluate(potential, r - h, &low, NULL, NULL);
        mf_table_evaluate(potential, r + h, &high, NULL, NULL);
        mf_table_evaluate(potential, r, NULL, &slope, NULL);
        assert_close(slope, (high - low) / (2 * h), tolerance * (1 + fabs(slope)));
    }
}

static void test_table_slope_is_the_derivative_of_its_value_when_differenced(void **state) {
    (void)state;
    check_gradient(&pairs_tables.soft, 0.05);
    check_gradient(&pairs_tables.lennard_jones, 0.85);
    check_gradient(&pairs_tables.gaussian, 0.05);
    check_gradient(&pairs_tables.sampled, 0.05);
}

/// Force on one of two particles at distance r, and their energy, from the kernel.
static double two_particle_force(const struct table *potential, enum pair_precision precision,
                                 double r, double *energy) {
    const struct box box = {3, {8, 8, 8}};
    struct pair_law law = pairs_law(potential, NULL);
    law.precision = precision;
    struct particles particles;
    struct neighbours neighbours;
    struct pair_sums sums;
    assert_ok(mf_particles_init(&particles, &box, 2));
    assert_ok(mf_particles_keep_precise(&particles));
    particles.position[0][0] = 7.9;
    particles.position[0][1] = 7.9 + r;
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &box, 2, potential->cutoff, 0.2));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    mf_pair_forces(&law, &particles, &neighbours, 1, PAIR_FORCES_AND_SUMS, &sums);
    *energy = sums.energy;
    const double force = particles.id[0] == 1 ? particles.force[0][0] : particles.force[0][1];
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
    return force;
}

/// Of one variant. Differences over a step h have an error of h²/6 Φ‴, for which twice the
/// difference of the curvatures stands, and that of the energies, `noise`.
static void check_energy_gradient(const struct variant *variant, double h, double noise) {
    const enum pair_precision precision = variant->precision;
    const struct table *potentials[] = {&pairs_tables.soft, &pairs_tables.lennard_jones,
                                        &pairs_tables.gaussian, &pairs_tables.sampled};
    variants_select(variant);
    for (int p = 0; p < 4; p++)
        for (double r = potentials[p] == &pairs_tables.lennard_jones ? 1 : 0.2;
             r < potentials[p]->cutoff - 0.02; r += 0.043) {
            double low, high, energy, curvature_low, curvature_high;
            two_particle_force(potentials[p], precision, r - h, &low);
            two_particle_force(potentials[p], precision, r + h, &high);
            mf_table_evaluate(potentials[p], r - h, NULL, NULL, &curvature_low);
            mf_table_evaluate(potentials[p], r + h, NULL, NULL, &curvature_high);
            const double force = two_particle_force(potentials[p], precision, r, &energy);
            assert_close(force, -(high - low) / (2 * h),
                         noise / h + 2 * h / 12 * fabs(curvature_high - curvature_low));
        }
}

/// Energies are of order 10, and good to 1e-7 or 1e-16 of that, a few times; in double precision
/// the distances, which come from coordinates of 8, are wrong by 1e-15, under forces of up to 40.
static void test_pair_force_is_minus_the_gradient_of_the_energy_when_differenced(void **state) {
    (void)state;
    for (int v = 0; v < variant_count; v++)
        if (variants[v].precision == PAIR_DOUBLE)
            check_energy_gradient(&variants[v], 1e-4, 1e-13);
        else
            check_energy_gradient(&variants[v], 0.01, 1e-5);
}

static void test_simd_select_refuses_when_the_name_is_unknown(void **state) {
    (void)state;
    assert_true(mf_simd_select("portable"));
    assert_false(mf_simd_select("mmx"));
    assert_string_equal(mf_simd_name(), "portable");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pair_forces_do_not_depend_on_order_or_skin_when_ids_are_the_same),
        cmocka_unit_test(test_pair_noise_changes_when_seed_or_step_changes),
        cmocka_unit_test(test_table_slope_is_the_derivative_of_its_value_when_differenced),
        cmocka_unit_test(test_pair_force_is_minus_the_gradient_of_the_energy_when_differenced),
        cmocka_unit_test(test_simd_select_refuses_when_the_name_is_unknown),
    };
    return cmocka_run_group_tests(tests, begin, pairs_end);
}
