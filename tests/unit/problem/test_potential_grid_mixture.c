// SPDX-License-Identifier: GPL-3.0-or-later
//
// The points of several potentials, one block for each pair type, each with a core of its own.
#include "problem/potential_grid.h"

#include "curves/formula.h"
#include "forces/many_body.h"
#include "observe/weighted_density.h"
#include "shared/is_close.h"
#include "shared/many_bodies.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 40, PAIRS = 3, POINTS = PAIRS * (BINS + 1) };

static const size_t cores[PAIRS] = {8, 0, 13};
enum { KNOWN = 3 * BINS - 8 - 13 };

static const double rounding = 1e-12, temperature = 1.3;

/// Nothing in the cores, then a peak of another height for each pair type.
static void make_target(double *target) {
    for (size_t n = 0; n < PAIRS * BINS; n++) {
        const size_t pair = n / BINS, k = n % BINS;
        const double r = 0.1 * ((double)k + 0.5);
        target[n] =
            k < cores[pair] ? 0 : 0.6 + (0.5 + 0.3 * (double)pair) * exp(-pow((r - 1.7) / 0.3, 2));
    }
}

static struct inverse_problem make_problem(const double *target) {
    return (struct inverse_problem){
        .targets = {.bins = {0, 0.1, BINS},
                    .target[TARGET_RDF] = {.count = PAIRS * BINS, .value = target}},
        .scene = {.temperature = temperature,
                  .composition = {.types = 2, .count = {20, 30}, .name = {"A", "B"}}},
        .core_threshold = 1e-3,
        .core_stiffness = 2000};
}

static void begin(struct potential_grid *grid, struct inverse_problem *problem, double *target) {
    make_target(target);
    *problem = make_problem(target);
    assert_ok(mf_potential_grid_init(grid, problem));
}

static void test_potential_grid_has_a_core_for_each_pair_type(void **state) {
    (void)state;
    double target[PAIRS * BINS];
    struct potential_grid grid;
    struct inverse_problem problem;
    size_t n = 0;
    begin(&grid, &problem, target);
    assert_int_equal(grid.pairs, PAIRS);
    assert_int_equal(grid.points, POINTS);
    assert_int_equal(grid.known, KNOWN);
    for (size_t pair = 0; pair < PAIRS; pair++) {
        const size_t block = mf_potential_grid_block(&grid, pair);
        assert_int_equal(block, pair * (BINS + 1));
        assert_int_equal(grid.core[pair], cores[pair]);
        assert_int_equal(grid.known_of[pair], BINS - cores[pair]);
        for (size_t k = 0; k <= BINS; k++) {
            assert_close(grid.r[block + k], k < BINS ? 0.1 * ((double)k + 0.5) : 4, rounding);
            assert_int_equal(mf_potential_grid_in_core(&grid, block + k), k < cores[pair]);
            assert_close(mf_potential_grid_ramp(&grid, block + k), 1 - grid.r[block + k] / 4,
                         rounding);
        }
        for (size_t k = cores[pair]; k < BINS; k++, n++) {
            assert_int_equal(grid.known_point[n], block + k);
            assert_int_equal(grid.known_bin[n], pair * BINS + k);
        }
    }
    assert_int_equal(n, KNOWN);
    mf_potential_grid_clear(&grid);
}

static void test_potential_grid_refuses_when_the_target_of_one_pair_type_is_empty(void **state) {
    (void)state;
    double target[PAIRS * BINS];
    struct potential_grid grid;
    struct inverse_problem problem;
    make_target(target);
    for (size_t k = 0; k < BINS; k++)
        target[BINS + k] = 0;
    problem = make_problem(target);
    assert_fails(mf_potential_grid_init(&grid, &problem), STATUS_BAD_INPUT, "A-B");
    mf_potential_grid_clear(&grid);
}

static void test_potential_grid_completes_each_core_and_each_end(void **state) {
    (void)state;
    double target[PAIRS * BINS], phi[POINTS];
    struct potential_grid grid;
    struct inverse_problem problem;
    begin(&grid, &problem, target);
    for (size_t n = 0; n < POINTS; n++)
        phi[n] = (double)(n / (BINS + 1)) + 2 - 20 * (5 + (double)(n / (BINS + 1))) * grid.r[n];
    mf_potential_grid_complete(&grid, phi);
    for (size_t pair = 0; pair < PAIRS; pair++) {
        const size_t block = mf_potential_grid_block(&grid, pair), first = block + cores[pair];
        const double push = 20 * (5 + (double)pair);
        for (size_t n = block; n < first; n++) {
            const double depth = grid.r[first] - grid.r[n];
            assert_close(phi[n], phi[first] + push * depth + 1000 * depth * depth, 1e-9);
        }
        for (size_t n = first; n < block + BINS; n++)
            assert_close(phi[n], (double)pair + 2 - push * grid.r[n], rounding);
        assert_identical(phi[block + BINS], 0.0);
    }
    mf_potential_grid_clear(&grid);
}

static void
test_potential_grid_starts_each_pair_type_from_its_curve_or_the_mean_force(void **state) {
    (void)state;
    struct formula_soft_repulsion_parameters soft[2] = {{40, 3}, {15, 3.5}};
    const struct curve first = {&mf_formula_soft_repulsion, &soft[0]},
                       last = {&mf_formula_soft_repulsion, &soft[1]};
    double target[PAIRS * BINS], phi[POINTS];
    struct potential_grid grid;
    struct inverse_problem problem;
    begin(&grid, &problem, target);
    problem.unknown[UNKNOWN_POTENTIAL].start[0] = &first;
    problem.unknown[UNKNOWN_POTENTIAL].start[2] = &last;
    mf_potential_grid_start(&grid, &problem, phi);
    for (size_t k = 0; k < BINS; k++) {
        if (k >= cores[0])
            assert_close(phi[k], mf_curve_value(&first, grid.r[k]), rounding);
        assert_close(phi[BINS + 1 + k], -temperature * log(target[BINS + k]), rounding);
        if (k >= cores[2])
            assert_close(phi[2 * (BINS + 1) + k], mf_curve_value(&last, grid.r[k]), rounding);
    }
    mf_potential_grid_clear(&grid);
}

static void test_potential_grid_table_goes_through_the_points_of_each_pair_type(void **state) {
    (void)state;
    double target[PAIRS * BINS], phi[POINTS], value;
    struct potential_grid grid;
    struct inverse_problem problem;
    struct table table;
    begin(&grid, &problem, target);
    mf_potential_grid_start(&grid, &problem, phi);
    assert_ok(mf_potential_grid_table(&grid, phi, &table));
    assert_int_equal(table.curves, PAIRS);
    for (int pair = 0; pair < PAIRS; pair++) {
        assert_close(table_cutoff(&table, pair), 4, rounding);
        for (size_t k = cores[pair]; k <= BINS; k++) {
            const size_t n = mf_potential_grid_block(&grid, (size_t)pair) + k;
            mf_table_evaluate_pair(&table, pair, grid.r[n], &value, NULL, NULL);
            assert_close(value, phi[n], 1e-3);
        }
    }
    mf_table_clear(&table);
    mf_potential_grid_clear(&grid);
}

/// As the grid of that pair type alone would have them, and nothing from one type to another.
static void test_potential_grid_virials_of_a_block_act_on_its_own_bins(void **state) {
    (void)state;
    static double virial[PAIRS * BINS * KNOWN], alone[BINS * BINS];
    double target[PAIRS * BINS], phi[POINTS];
    struct potential_grid grid;
    struct inverse_problem problem;
    begin(&grid, &problem, target);
    mf_potential_grid_start(&grid, &problem, phi);
    assert_ok(mf_potential_grid_virials(&grid, &problem.targets.bins, 3, phi, virial));
    for (size_t pair = 0, first = 0; pair < PAIRS; first += grid.known_of[pair++]) {
        struct potential_grid own;
        struct inverse_problem one = problem;
        double largest = 0;
        one.scene.composition = mf_composition_of_one(50);
        one.targets.target[TARGET_RDF].value = target + pair * BINS;
        assert_ok(mf_potential_grid_init(&own, &one));
        assert_ok(mf_potential_grid_virials(&own, &problem.targets.bins, 3,
                                            phi + mf_potential_grid_block(&grid, pair), alone));
        for (size_t a = 0; a < PAIRS * BINS; a++)
            for (size_t b = 0; b < own.known; b++) {
                const double found = virial[a * KNOWN + first + b];
                if (a / BINS == pair)
                    assert_close(found, alone[a % BINS * own.known + b], 1e-9);
                else
                    assert_identical(found, 0.0);
                largest = fmax(largest, fabs(found));
            }
        assert_true(largest > 1);
        mf_potential_grid_clear(&own);
    }
    mf_potential_grid_clear(&grid);
}

/// f − sρ with Φ + 2s w is the same energy only if all pairs get their part of it: beside a law
/// that the scene gives, the slope of f is f's own.
static void test_potential_grid_shares_the_slope_of_f_with_all_pairs_or_none(void **state) {
    enum { RHO_BINS = 20 };
    static const struct weighted_density_settings weight = {0.5, 1.2, RHO_BINS, RHO_BINS};
    (void)state;
    double target[PAIRS * BINS], rho[RHO_BINS], p[RHO_BINS];
    struct potential_grid grid;
    struct inverse_problem problem;
    struct many_body law;
    const int kind = mf_weighted_density_kind();
    make_target(target);
    problem = make_problem(target);
    for (int k = 0; k < RHO_BINS; k++) {
        rho[k] = k + 0.5;
        p[k] = exp(-pow((rho[k] - 10) / 4, 2));
    }
    many_bodies_crowd(&law, weight.inner_cutoff, weight.cutoff, 0, 0, &problem.scene.composition);
    problem.scene.interaction[problem.scene.interactions++] =
        (struct interaction_choice){&mf_many_body, &law};
    problem.targets.target[kind] = (struct target){RHO_BINS, p, .x = rho};
    problem.targets.settings[mf_observable_kind(kind).place] = &weight;
    problem.unknown[UNKNOWN_POTENTIAL].wanted = problem.unknown[UNKNOWN_BONDED].wanted = true;
    problem.group[problem.bonded++] =
        (struct bonded_unknown){.order = INVERSE_LOCAL_DENSITY, .bins = {0, 1, RHO_BINS}};
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_true(grid.group[0].own.is_level);
    assert_non_null(grid.shared.change);
    mf_potential_grid_clear(&grid);
    for (size_t k = 0; k < BINS; k++)
        target[BINS + k] = NAN; // A-B is not looked for
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_false(grid.group[0].own.is_level);
    assert_null(grid.shared.change);
    mf_potential_grid_clear(&grid);
    mf_many_body_clear(&law);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_potential_grid_has_a_core_for_each_pair_type),
        cmocka_unit_test(test_potential_grid_refuses_when_the_target_of_one_pair_type_is_empty),
        cmocka_unit_test(test_potential_grid_completes_each_core_and_each_end),
        cmocka_unit_test(
            test_potential_grid_starts_each_pair_type_from_its_curve_or_the_mean_force),
        cmocka_unit_test(test_potential_grid_table_goes_through_the_points_of_each_pair_type),
        cmocka_unit_test(test_potential_grid_virials_of_a_block_act_on_its_own_bins),
        cmocka_unit_test(test_potential_grid_shares_the_slope_of_f_with_all_pairs_or_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
