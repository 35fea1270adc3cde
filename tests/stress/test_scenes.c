// SPDX-License-Identifier: GPL-3.0-or-later
//
// Potentials, temperatures, sizes and starts beyond the ordinary.
#include "base/rng.h"
#include "curves/sampled.h"
#include "dynamics/aboba.h"
#include "io/data_table.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/stability.h"
#include "shared/testing.h"

enum { MAX_POINTS = 600 };

static void make_table(struct table *table, const double *r, const double *value, size_t points) {
    struct curve curve;
    assert_ok(mf_sampled_create(&curve, r, value, points));
    assert_ok(mf_table_init_potential(table, &curve));
    mf_curve_clear(&curve);
}

/// A fluid of density 0.8 and friction within 1.5 that has this potential.
static void make_fluid(struct fluid *fluid, const struct table *potential, double time_step) {
    fluid_lennard_jones(fluid, 500, time_step);
    fluid->setup.potential = potential;
    fluid->setup.temperature = 1;
    fluid->setup.temperature_limit = 20;
}

static const struct integrator *const dissipative[] = {
    &mf_dpd_verlet, &mf_dpd_vv, &mf_shardlow, &mf_aboba, &mf_aboba_implicit, &mf_lowe_andersen};
enum { DISSIPATIVE = sizeof dissipative / sizeof *dissipative };

/// All integrators end as `expected` with this potential.
static void check(const struct table *potential, double time_step, enum placement_kind kind,
                  enum stability expected) {
    for (int k = 0; k < DISSIPATIVE; k++) {
        struct fluid fluid;
        make_fluid(&fluid, potential, time_step);
        fluid.setup.placement.kind = (int)kind;
        fluid.setup.integrator = dissipative[k];
        assert_int_equal(stability_run(&fluid.setup, NULL, (int64_t)(5 / time_step), 20), expected);
        fluid_clear(&fluid);
    }
}

static void test_steep_table_is_good_when_the_time_step_is_small(void **state) {
    (void)state;
    double r[MAX_POINTS], value[MAX_POINTS];
    struct table table;
    for (int k = 0; k < MAX_POINTS; k++) {
        r[k] = 0.7 + 0.8 * k / (MAX_POINTS - 1);
        value[k] = pow(r[k], -24) - pow(1.5, -24);
    }
    make_table(&table, r, value, MAX_POINTS);
    check(&table, 0.001, PLACEMENT_LATTICE, STABILITY_GOOD);
    check(&table, 0.001, PLACEMENT_RANDOM, STABILITY_GOOD);
    check(&table, 0.1, PLACEMENT_LATTICE, STABILITY_UNSTABLE);
    mf_table_clear(&table);
}

static void test_water_table_is_good_from_a_lattice_and_from_random_places(void **state) {
    (void)state;
    struct data_table points;
    double r[MAX_POINTS], value[MAX_POINTS];
    struct table table;
    assert_ok(mf_data_table_read(&points, "tests/bench/scenes/cgwater.tsv", 2));
    assert_true(points.rows <= MAX_POINTS);
    for (size_t k = 0; k < points.rows; k++) {
        r[k] = points.values[k * points.columns];
        value[k] = points.values[k * points.columns + 1];
    }
    make_table(&table, r, value, points.rows);
    check(&table, 0.01, PLACEMENT_LATTICE, STABILITY_GOOD);
    check(&table, 0.01, PLACEMENT_RANDOM, STABILITY_GOOD);
    mf_table_clear(&table);
    mf_data_table_clear(&points);
}

/// A raw random walk of 100 points, and 20 points of a smooth curve.
static void test_rough_and_coarse_tables_end_in_one_of_three_ways(void **state) {
    (void)state;
    double r[100], value[100];
    struct table table;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct rng_sequence sequence = mf_rng_sequence_begin(seed, RNG_INITIAL, 0, 0);
        double walk = 0;
        for (int k = 99; k >= 0; k--) {
            r[k] = k / 99.0;
            value[k] = walk;
            walk += mf_rng_sequence_uniform(&sequence) - 0.3;
        }
        make_table(&table, r, value, 100);
        for (int k = 0; k < DISSIPATIVE; k++) {
            struct fluid fluid;
            make_fluid(&fluid, &table, 0.01);
            fluid.setup.integrator = dissipative[k];
            (void)stability_run(&fluid.setup, NULL, 500, 20);
            fluid_clear(&fluid);
        }
        mf_table_clear(&table);
    }
    for (int k = 0; k < 20; k++) {
        r[k] = k / 19.0;
        value[k] = 12.5 * (1 - r[k]) * (1 - r[k]);
    }
    make_table(&table, r, value, 20);
    check(&table, 0.02, PLACEMENT_LATTICE, STABILITY_GOOD);
    mf_table_clear(&table);
}

static void test_standard_fluid_is_good_when_cold_and_hot(void **state) {
    (void)state;
    static const double temperatures[] = {0.01, 10};
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < DISSIPATIVE; k++) {
            struct fluid fluid;
            fluid_groot_warren(&fluid, 500, 0.01);
            fluid.setup.temperature = temperatures[t];
            fluid.setup.integrator = dissipative[k];
            // A cold fluid falls from its lattice, which is hotter than it by far.
            fluid.setup.temperature_limit = 1000;
            assert_int_equal(stability_run(&fluid.setup, NULL, 4000, 20), STABILITY_GOOD);
            fluid_clear(&fluid);
        }
}

/// From a box that is two cutoffs to a million particles, which take a few steps.
static void test_standard_fluid_runs_at_any_size(void **state) {
    (void)state;
    static const int64_t counts[] = {8, 25, 81, 1000, 1000000};
    for (int n = 0; n < 5; n++)
        for (int k = 0; k < DISSIPATIVE; k++) {
            struct fluid fluid;
            fluid_groot_warren(&fluid, counts[n], 0.01);
            for (int d = 0; d < 3; d++)
                fluid.setup.box.length[d] = fmax(2.0001, fluid.setup.box.length[d]);
            fluid.setup.integrator = dissipative[k];
            if (counts[n] < 10000) {
                assert_int_equal(stability_run(&fluid.setup, NULL, 2000, 40), STABILITY_GOOD);
            } else {
                struct simulation simulation;
                assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
                assert_ok(mf_simulation_run(&simulation, 3));
                // On its way from the lattice it is colder for a while.
                assert_close(mf_particles_temperature(&simulation.particles), 0.95, 0.05);
                mf_simulation_clear(&simulation);
            }
            fluid_clear(&fluid);
        }
}

/// Positions are wrapped before anything else: 200,000 boxes away is 1e-10 λ of rounding,
/// which 20 steps magnify little. Beyond 2^18 boxes they are refused.
static void test_positions_may_be_200000_boxes_away(void **state) {
    (void)state;
    enum { COUNT = 300 };
    static double near[3][COUNT], far[3][COUNT];
    struct fluid fluid;
    struct simulation first, here, there;
    fluid_groot_warren(&fluid, COUNT, 0.01);
    assert_ok(mf_simulation_init(&first, &fluid.setup, NULL));
    for (int d = 0; d < 3; d++)
        for (int k = 0; k < COUNT; k++) {
            near[d][k] = first.particles.position[d][k];
            far[d][k] = near[d][k] + (k % 2 ? 2e5 : -2e5) * fluid.setup.box.length[d];
        }
    fluid.setup.placement.kind = PLACEMENT_FILE;
    fluid.setup.precision = PAIR_DOUBLE;
    for (int k = 0; k < DISSIPATIVE; k++) {
        struct simulation_start start = {.position = {near[0], near[1], near[2]}};
        fluid.setup.integrator = dissipative[k];
        const struct aboba_parameters exact = {.tolerance = 1e-8};
        fluid.setup.integrator_parameters = dissipative[k] == &mf_aboba_implicit ? &exact : NULL;
        assert_ok(mf_simulation_init(&here, &fluid.setup, &start));
        for (int d = 0; d < 3; d++)
            start.position[d] = far[d];
        assert_ok(mf_simulation_init(&there, &fluid.setup, &start));
        assert_ok(mf_simulation_run(&here, 20));
        assert_ok(mf_simulation_run(&there, 20));
        double velocity[2][COUNT];
        for (int n = 0; n < COUNT; n++) {
            velocity[0][here.particles.id[n]] = here.particles.velocity[0][n];
            velocity[1][there.particles.id[n]] = there.particles.velocity[0][n];
        }
        for (int n = 0; n < COUNT; n++)
            if (dissipative[k] != &mf_lowe_andersen) // a collision is a matter of yes or no
                assert_close(velocity[0][n], velocity[1][n], 1e-4);
        mf_simulation_clear(&here);
        mf_simulation_clear(&there);
    }
    mf_simulation_clear(&first);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steep_table_is_good_when_the_time_step_is_small),
        cmocka_unit_test(test_water_table_is_good_from_a_lattice_and_from_random_places),
        cmocka_unit_test(test_rough_and_coarse_tables_end_in_one_of_three_ways),
        cmocka_unit_test(test_standard_fluid_is_good_when_cold_and_hot),
        cmocka_unit_test(test_standard_fluid_runs_at_any_size),
        cmocka_unit_test(test_positions_may_be_200000_boxes_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
