// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/potential_grid.h"

#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 40, CORE = 8 };

static const double rounding = 1e-12;

/// Nothing below r = 0.8, a peak, then 1: with bins of 0.1 from 0 on.
static void make_target(double *target) {
    for (int k = 0; k < BINS; k++) {
        const double r = 0.1 * (k + 0.5);
        target[k] = k < CORE ? 0 : 1 + 1.5 * exp(-pow((r - 1.1) / 0.15, 2)) - exp(-8 * (r - 0.75));
    }
}

static struct inverse_problem make_problem(const double *target) {
    return (struct inverse_problem){
        .targets = {.bins = {0, 0.1, BINS}, .target[TARGET_RDF] = {.count = BINS, .value = target}},
        .scene = {.temperature = 1.3},
        .core_threshold = 1e-3,
        .core_stiffness = 2000};
}

static void test_potential_grid_has_three_parts_when_the_target_has_a_core(void **state) {
    (void)state;
    double target[BINS];
    struct potential_grid grid;
    make_target(target);
    // Few pairs in the core do not end it; a hole beyond it does not belong to it.
    target[CORE - 1] = 1e-3;
    target[20] = 0;
    const struct inverse_problem problem = make_problem(target);
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE);
    assert_int_equal(grid.known, BINS - CORE);
    assert_int_equal(grid.points, BINS + 1);
    assert_close(grid.r[0], 0.05, rounding);
    assert_close(grid.r[BINS - 1], 3.95, rounding);
    assert_close(grid.r[BINS], 4, rounding);
    mf_potential_grid_clear(&grid);
}

/// A bin with a single pair of a whole measurement: g is its own error. One in which there are
/// more, but beyond which there is a gap, tells nothing of the gap.
static void test_potential_grid_core_takes_in_single_pairs_when_errors_tell(void **state) {
    (void)state;
    double target[BINS], error[BINS];
    struct potential_grid grid;
    make_target(target);
    struct inverse_problem problem = make_problem(target);
    problem.targets.target[TARGET_RDF].error = error;
    for (int k = 0; k < BINS; k++)
        error[k] = 1e-3;
    target[CORE - 1] = error[CORE - 1] = 0.05;
    target[0] = error[0] = 0.3; // the least volume
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE);
    mf_potential_grid_clear(&grid);
    target[CORE - 3] = 0.05;
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE);
    // Without the bin at 0 some pairs come as near as CORE − 3: a line as far, then a parabola.
    mf_potential_grid_clear(&grid);
    target[0] = 0;
    assert_ok(mf_potential_grid_init(&grid, &problem));
    double phi[BINS + 1] = {[CORE] = 5, [CORE + 1] = 3};
    mf_potential_grid_complete(&grid, phi);
    assert_close(phi[CORE - 3], 11, rounding);
    assert_close(phi[CORE - 5], 15 + 0.5 * 2000 * 0.2 * 0.2, 1e-9);
    mf_potential_grid_clear(&grid);
    error[CORE - 1] = 0.02;
    target[CORE - 2] = 0.01;
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE - 3);
    mf_potential_grid_clear(&grid);
}

/// Pairs that were seen inside by chance, with an empty bin between them and the others, do not end
/// the core; nor does a hole beyond what is well known begin it again.
static void test_potential_grid_takes_stray_pairs_for_the_core(void **state) {
    (void)state;
    double target[BINS];
    struct potential_grid grid;
    make_target(target);
    target[CORE - 4] = 0.002;
    target[CORE - 3] = 0.09;
    target[CORE - 1] = 0.05;
    target[20] = 0;
    struct inverse_problem problem = make_problem(target);
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE - 1);
    mf_potential_grid_clear(&grid);
    // A well-known g is no chance.
    target[CORE - 3] = 0.11;
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE - 4);
    mf_potential_grid_clear(&grid);
}

/// Types that hardly meet have a core as others do.
static void test_potential_grid_has_a_core_when_pairs_are_rare_everywhere(void **state) {
    (void)state;
    double target[BINS];
    struct potential_grid grid;
    make_target(target);
    for (int k = 0; k < BINS; k++)
        target[k] *= 0.01;
    const struct inverse_problem problem = make_problem(target);
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE);
    mf_potential_grid_clear(&grid);
}

/// Two states: the second one has pairs two bins nearer to each other.
static void test_potential_grid_of_states_knows_which_one_saw_a_bin(void **state) {
    (void)state;
    double far[BINS], near[BINS];
    struct potential_grid grid;
    make_target(far);
    make_target(near);
    near[CORE - 2] = near[CORE - 1] = 0.02;
    struct inverse_problem problem[] = {make_problem(far), make_problem(near)};
    const struct inverse_problem *all[] = {&problem[0], &problem[1]};
    for (int s = 0; s < 2; s++) {
        problem[s].state = all;
        problem[s].states = 2;
    }
    for (int s = 0; s < 2; s++) {
        assert_ok(mf_potential_grid_init(&grid, &problem[s]));
        assert_int_equal(grid.core[0], CORE - 2);
        assert_int_equal(grid.seen[0], s == 1);
        assert_int_equal(grid.seen[1], s == 1);
        assert_true(grid.seen[2]);
        mf_potential_grid_clear(&grid);
    }
}

static void test_potential_grid_has_no_core_when_the_target_begins_at_once(void **state) {
    (void)state;
    double target[BINS], phi[BINS + 1] = {0};
    struct potential_grid grid;
    for (int k = 0; k < BINS; k++)
        target[k] = 0.5;
    const struct inverse_problem problem = make_problem(target);
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], 0);
    mf_potential_grid_start(&grid, &problem, phi);
    assert_close(phi[0], 1.3 * log(2), rounding);
    mf_potential_grid_clear(&grid);
}

static void test_potential_grid_refuses_when_the_target_is_empty(void **state) {
    (void)state;
    double target[BINS] = {0};
    struct potential_grid grid;
    const struct inverse_problem problem = make_problem(target);
    assert_fails(mf_potential_grid_init(&grid, &problem), STATUS_BAD_INPUT, "0.001");
}

static void test_potential_grid_starts_from_the_mean_force_when_there_is_no_start(void **state) {
    (void)state;
    double target[BINS], phi[BINS + 1];
    struct potential_grid grid;
    make_target(target);
    target[20] = 0;
    const struct inverse_problem problem = make_problem(target);
    assert_ok(mf_potential_grid_init(&grid, &problem));
    mf_potential_grid_start(&grid, &problem, phi);
    for (int k = CORE; k < BINS; k++)
        assert_close(phi[k], -1.3 * log(k == 20 ? 1e-3 : target[k]), rounding);
    assert_identical(phi[BINS], 0.0);
    mf_potential_grid_clear(&grid);
}

static void test_potential_grid_starts_from_the_curve_when_there_is_one(void **state) {
    (void)state;
    struct formula_soft_repulsion_parameters soft = {40, 3};
    const struct curve curve = {&mf_formula_soft_repulsion, &soft};
    double target[BINS], phi[BINS + 1];
    struct potential_grid grid;
    make_target(target);
    struct inverse_problem problem = make_problem(target);
    problem.unknown[UNKNOWN_POTENTIAL].start[0] = &curve;
    assert_ok(mf_potential_grid_init(&grid, &problem));
    mf_potential_grid_start(&grid, &problem, phi);
    for (int k = CORE; k < BINS; k++)
        assert_close(phi[k], mf_curve_value(&curve, grid.r[k]), rounding);
    mf_potential_grid_clear(&grid);
}

static void test_potential_grid_core_is_the_parabola_when_completed(void **state) {
    (void)state;
    double target[BINS], phi[BINS + 1];
    // Falling and rising at the first known point: the core never attracts, and as g is 0.37 there
    // and below the threshold of 0.001 a bin before, it has a slope of 77 at least.
    static const double slopes[] = {-130, -30, 25};
    make_target(target);
    const struct inverse_problem problem = make_problem(target);
    for (int s = 0; s < 3; s++) {
        struct potential_grid grid;
        assert_ok(mf_potential_grid_init(&grid, &problem));
        for (int k = CORE; k <= BINS; k++)
            phi[k] = 2 + slopes[s] * (grid.r[k] - grid.r[CORE]);
        mf_potential_grid_complete(&grid, phi);
        const double push = fmax(-slopes[s], 1.3 * log(target[CORE] / 1e-3) / 0.1);
        for (int k = 0; k < CORE; k++) {
            const double depth = grid.r[CORE] - grid.r[k];
            assert_close(phi[k], 2 + push * depth + 1000 * depth * depth, 1e-9);
            assert_true(phi[k] > phi[k + 1]);
        }
        assert_identical(phi[BINS], 0.0);
        mf_potential_grid_clear(&grid);
    }
}

/// At least as much as the most that there may be in the bin before the first known one: two errors
/// more than was seen, or three pairs where none was, of which one makes 0.09 of g a bin farther.
static void test_potential_grid_core_rises_as_g_falls(void **state) {
    (void)state;
    double target[BINS], error[BINS], phi[BINS + 1];
    struct potential_grid grid;
    make_target(target);
    for (int k = 0; k < BINS; k++)
        error[k] = 1e-3;
    target[CORE - 1] = error[CORE - 1] = 0.2 * target[CORE];
    struct inverse_problem problem = make_problem(target);
    problem.targets.target[TARGET_RDF].error = error;
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE);
    for (int k = CORE; k <= BINS; k++)
        phi[k] = 3 * (grid.r[k] - grid.r[CORE]);
    mf_potential_grid_complete(&grid, phi);
    assert_close(phi[CORE - 1], 1.3 * log(1 / 0.6), 1e-9);
    mf_potential_grid_clear(&grid);
    target[CORE - 1] = error[CORE - 1] = 0;
    error[CORE] = 0.3 * target[CORE];
    assert_ok(mf_potential_grid_init(&grid, &problem));
    assert_int_equal(grid.core[0], CORE);
    mf_potential_grid_complete(&grid, phi);
    const double shells = pow(grid.r[CORE] / grid.r[CORE - 1], 2);
    assert_close(phi[CORE - 1], 1.3 * log(1 / (3 * 0.09 * shells)) + 1000 * 0.01, 1e-9);
    mf_potential_grid_clear(&grid);
}

static void test_potential_grid_table_is_smooth_and_repulsive_when_there_is_a_core(void **state) {
    (void)state;
    double target[BINS], phi[BINS + 1], value, slope, before = INFINITY, slope_before = NAN;
    struct potential_grid grid;
    struct table table;
    make_target(target);
    const struct inverse_problem problem = make_problem(target);
    assert_ok(mf_potential_grid_init(&grid, &problem));
    mf_potential_grid_start(&grid, &problem, phi);
    assert_ok(mf_potential_grid_table(&grid, phi, &table));
    assert_close(table.cutoff, 4, rounding);
    // The largest second derivative is about the stiffness: the slope changes by no more than a few
    // times that over a step, also where the core begins.
    const double step = 1e-3, largest_bend = 3 * 2000 * step;
    for (double r = 0; r < 0.85; r += step) {
        mf_table_evaluate(&table, r, &value, &slope, NULL);
        assert_true(isfinite(value) && isfinite(slope));
        assert_true(value < before);
        assert_true(slope < 0);
        if (r > 0)
            assert_true(fabs(slope - slope_before) < largest_bend);
        before = value;
        slope_before = slope;
    }
    // Through the points, and 0 at the cutoff and beyond.
    for (int k = CORE; k < BINS; k++) {
        mf_table_evaluate(&table, grid.r[k], &value, NULL, NULL);
        assert_close(value, phi[k], 1e-3);
    }
    mf_table_evaluate(&table, 4 - 1e-9, &value, NULL, NULL);
    assert_close(value, 0, 1e-6);
    mf_table_evaluate(&table, 4.1, &value, &slope, NULL);
    assert_identical(value, 0.0);
    assert_identical(slope, 0.0);
    mf_table_clear(&table);
    mf_potential_grid_clear(&grid);
}

/// Mean of −r Φ'(r) over a bin's shell by many points.
static double virial_of(const struct potential_grid *grid, const double *phi,
                        const struct rdf_bins *bins, size_t bin) {
    enum { MANY = 1000 };
    struct table table;
    double sum = 0, volume = 0;
    assert_ok(mf_potential_grid_table(grid, phi, &table));
    for (int k = 0; k < MANY; k++) {
        const double r = mf_rdf_bins_edge(bins, bin) + (k + 0.5) / MANY * bins->width;
        double slope;
        mf_table_evaluate(&table, r, NULL, &slope, NULL);
        sum -= r * r * r * slope;
        volume += r * r;
    }
    mf_table_clear(&table);
    return sum / volume;
}

static void test_potential_grid_virials_are_those_of_a_changed_table(void **state) {
    (void)state;
    static double virial[BINS * BINS];
    double target[BINS], phi[BINS + 1] = {0}, changed[BINS + 1];
    struct potential_grid grid;
    make_target(target);
    const struct inverse_problem problem = make_problem(target);
    const struct rdf_bins *bins = &problem.targets.bins;
    assert_ok(mf_potential_grid_init(&grid, &problem));
    mf_potential_grid_start(&grid, &problem, phi);
    assert_ok(mf_potential_grid_virials(&grid, bins, 3, phi, virial));
    for (size_t k = 0; k < grid.points; k++)
        changed[k] = phi[k] + 0.3 * mf_potential_grid_ramp(&grid, k) + 0.1 * cos(3 * grid.r[k]);
    mf_potential_grid_complete(&grid, changed);
    for (size_t a = 0; a < BINS; a++) {
        double predicted = 0;
        for (size_t b = 0; b < grid.known; b++)
            predicted += virial[a * grid.known + b] * (changed[CORE + b] - phi[CORE + b]);
        // The spline's end at the cutoff is steep; the change of its slope there is of order 1.
        assert_close(predicted, virial_of(&grid, changed, bins, a) - virial_of(&grid, phi, bins, a),
                     0.01);
    }
    mf_potential_grid_clear(&grid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_potential_grid_has_three_parts_when_the_target_has_a_core),
        cmocka_unit_test(test_potential_grid_core_takes_in_single_pairs_when_errors_tell),
        cmocka_unit_test(test_potential_grid_takes_stray_pairs_for_the_core),
        cmocka_unit_test(test_potential_grid_has_a_core_when_pairs_are_rare_everywhere),
        cmocka_unit_test(test_potential_grid_of_states_knows_which_one_saw_a_bin),
        cmocka_unit_test(test_potential_grid_has_no_core_when_the_target_begins_at_once),
        cmocka_unit_test(test_potential_grid_refuses_when_the_target_is_empty),
        cmocka_unit_test(test_potential_grid_starts_from_the_mean_force_when_there_is_no_start),
        cmocka_unit_test(test_potential_grid_starts_from_the_curve_when_there_is_one),
        cmocka_unit_test(test_potential_grid_core_is_the_parabola_when_completed),
        cmocka_unit_test(test_potential_grid_core_rises_as_g_falls),
        cmocka_unit_test(test_potential_grid_table_is_smooth_and_repulsive_when_there_is_a_core),
        cmocka_unit_test(test_potential_grid_virials_are_those_of_a_changed_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
