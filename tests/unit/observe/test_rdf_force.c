// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/rdf_force.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

/// Of a few operations on numbers of order 1 to 100, and of single-precision pairs.
static const double rounding = 1e-12, single = 1e-5;

enum { BINS = 20, SAMPLES = 40 };
static const struct rdf_bins bins = {0, 0.1, BINS};

/// Samples of an ideal gas, each with new positions.
static void measure_ideal_gas(int dimensions, struct rdf *rdf, struct rdf_force *force) {
    struct fluid fluid;
    struct table nothing;
    fluid_ideal_gas(&fluid, dimensions, 200, 0.01);
    fluid_no_potential(&nothing);
    const struct box *box = &fluid.setup.box;
    assert_ok(mf_rdf_init(rdf, &bins, box, 200, 0, SAMPLES));
    assert_ok(mf_rdf_force_init(force, &bins, box, 200, &nothing, 1, 0, SAMPLES));
    for (uint64_t sample = 0; sample < SAMPLES; sample++) {
        struct particles particles;
        assert_ok(mf_particles_init(&particles, box, 200));
        assert_ok(mf_placement_random(&particles, 0, sample));
        assert_ok(mf_rdf_sample(rdf, &particles, NULL));
        assert_ok(mf_rdf_force_sample(force, &particles, NULL));
        mf_particles_clear(&particles);
    }
    mf_table_clear(&nothing);
    fluid_clear(&fluid);
}

/// Without forces g is as flat as can be: the number of pairs in range over that of g = 1 in every
/// bin, to the bit, so that bins have no noise of their own. That number is 1 within its error.
static void test_rdf_force_from_infinity_is_flat_when_the_gas_is_ideal(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct rdf rdf;
        struct rdf_force force;
        double g[BINS], error[BINS], h[BINS], pairs = 0, ideal = 0;
        measure_ideal_gas(dimensions, &rdf, &force);
        assert_ok(mf_rdf_force_result(&force, 1, RDF_FORCE_FROM_INFINITY, g, error));
        assert_ok(mf_rdf_result(&rdf, 1, h, NULL));
        for (size_t k = 0; k < BINS; k++) {
            assert_identical(g[k], g[0]);
            assert_identical(error[k], error[0]);
            pairs += h[k] * mf_rdf_ideal_pairs(&bins, k, &rdf.box, 200);
            ideal += mf_rdf_ideal_pairs(&bins, k, &rdf.box, 200);
        }
        assert_close(g[0], pairs / ideal, rounding);
        // The pairs are uncorrelated: Poisson. 5 errors.
        assert_close(g[0], 1, 5 / sqrt(ideal * SAMPLES));
        assert_close_relative(error[0], 1 / sqrt(ideal * SAMPLES), 0.5);
        mf_rdf_clear(&rdf);
        mf_rdf_force_clear(&force);
    }
}

static void test_rdf_force_counted_is_the_histogram_when_there_are_no_forces(void **state) {
    (void)state;
    struct rdf rdf;
    struct rdf_force force;
    double g[BINS], error[BINS], h[BINS], h_error[BINS], zero[BINS];
    measure_ideal_gas(3, &rdf, &force);
    assert_ok(mf_rdf_result(&rdf, 1, h, h_error));
    assert_ok(mf_rdf_force_result(&force, 1, RDF_FORCE_COUNTED, g, error));
    assert_ok(mf_rdf_force_result(&force, 1, RDF_FORCE_FROM_ZERO, zero, NULL));
    for (size_t k = 0; k < BINS; k++) {
        // Two pairs on an edge may be counted on its other side.
        const double few = 2 / (SAMPLES * mf_rdf_ideal_pairs(&bins, k, &rdf.box, 200));
        assert_close(g[k], h[k], few + rounding);
        assert_close(error[k], h_error[k], few + rounding); // the jackknife of a mean
        assert_identical(zero[k], 0.0);
    }
    mf_rdf_clear(&rdf);
    mf_rdf_force_clear(&force);
}

/// Two particles 0.55 apart in the soft potential: F = 25 · 0.45.
static void test_rdf_force_is_known_when_there_is_one_pair(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct fluid fluid;
        struct particles particles;
        struct rdf_force force;
        double g[BINS];
        fluid_groot_warren(&fluid, 300, 0.01);
        const struct box box = {dimensions, {5, 6, dimensions == 3 ? 7 : 1}};
        assert_ok(mf_particles_init(&particles, &box, 2));
        for (int d = 0; d < dimensions; d++)
            particles.position[d][0] = particles.position[d][1] = 1;
        particles.position[0][1] = 1.55;
        assert_ok(mf_rdf_force_init(&force, &bins, &box, 2, &fluid.potential, 2, 0, 1));
        assert_ok(mf_rdf_force_sample(&force, &particles, NULL));
        assert_ok(mf_rdf_force_result(&force, 1, RDF_FORCE_FROM_ZERO, g, NULL));
        // β F r / (Ω I r^d), I = 1/V, beyond the bin of the pair.
        const double solid = dimensions == 3 ? 4 * M_PI : 2 * M_PI;
        const double whole =
            25 * 0.45 / 2 * mf_box_volume(&box) / (solid * pow(0.55, dimensions - 1));
        const double low = pow(0.5, dimensions), high = pow(0.6, dimensions);
        for (size_t k = 0; k < BINS; k++)
            assert_close_relative(g[k],
                                  k < 5    ? 0
                                  : k == 5 ? whole * (high - pow(0.55, dimensions)) / (high - low)
                                           : whole,
                                  single);
        mf_rdf_force_clear(&force);
        mf_particles_clear(&particles);
        fluid_clear(&fluid);
    }
}

static void test_rdf_force_applies_when_particles_are_kept_apart(void **state) {
    (void)state;
    struct fluid fluid;
    struct table nothing;
    fluid_groot_warren(&fluid, 300, 0.01); // Φ(0) = 12.5
    fluid_no_potential(&nothing);
    assert_true(mf_rdf_force_applies(&fluid.potential, 1));
    assert_false(mf_rdf_force_applies(&fluid.potential, 1.3));
    assert_false(mf_rdf_force_applies(&nothing, 1));
    assert_false(mf_rdf_force_applies(NULL, 1));
    mf_table_clear(&nothing);
    fluid_clear(&fluid);
}

static void test_rdf_force_init_refuses_when_the_range_exceeds_half_the_box(void **state) {
    (void)state;
    const struct box box = {3, {6, 3.9, 8}};
    struct fluid fluid;
    struct rdf_force force;
    fluid_groot_warren(&fluid, 300, 0.01);
    assert_fails(mf_rdf_force_init(&force, &bins, &box, 10, &fluid.potential, 1, 1, 5),
                 STATUS_BAD_INPUT, "RDF");
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rdf_force_from_infinity_is_flat_when_the_gas_is_ideal),
        cmocka_unit_test(test_rdf_force_counted_is_the_histogram_when_there_are_no_forces),
        cmocka_unit_test(test_rdf_force_is_known_when_there_is_one_pair),
        cmocka_unit_test(test_rdf_force_applies_when_particles_are_kept_apart),
        cmocka_unit_test(test_rdf_force_init_refuses_when_the_range_exceeds_half_the_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
