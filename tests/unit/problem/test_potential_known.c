// SPDX-License-Identifier: GPL-3.0-or-later
//
// A part of the potential that is known, beside the one that is looked for.
#include "curves/formula.h"
#include "problem/potential_grid.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { BINS = 40, CORE = 18 };

static const double width = 0.05, temperature = 1.3;

/// A gas of Lennard-Jones particles, each bin with the mean of exp(−Φ/k_B T) over its shell, and no
/// pairs nearer than 0.9.
static void make_target(const struct curve *truth, double *target) {
    for (int k = 0; k < BINS; k++) {
        double sum = 0, volume = 0;
        for (double r = width * k + 0.0005; r < width * (k + 1); r += 0.001) {
            sum += r * r * exp(-mf_curve_value(truth, r) / temperature);
            volume += r * r;
        }
        target[k] = k < CORE ? 0 : sum / volume;
    }
}

struct twin {
    struct curve law;
    double target[BINS];
    struct inverse_problem problem;
};

static void make_twin(struct twin *twin) {
    *twin =
        (struct twin){.problem = {.scene = {.box = {.dimensions = 3}, .temperature = temperature},
                                  .core_threshold = 1e-3,
                                  .core_stiffness = 2000}};
    assert_ok(mf_curve_create(&twin->law, &mf_formula_lennard_jones));
    make_target(&twin->law, twin->target);
    twin->problem.targets.bins = (struct rdf_bins){0, width, BINS};
    twin->problem.targets.target[TARGET_RDF] =
        (struct target){.count = BINS, .value = twin->target};
    twin->problem.known = (struct inverse_law){1, &twin->law};
}

/// Where all is known nothing is left, and the core of nothing is flat.
static void test_start_is_zero_when_the_whole_potential_is_known(void **state) {
    (void)state;
    struct twin twin;
    struct potential_grid grid;
    double phi[BINS + 1];
    make_twin(&twin);
    assert_ok(mf_potential_grid_init(&grid, &twin.problem));
    mf_potential_grid_start(&grid, &twin.problem, phi);
    for (int k = 0; k < BINS; k++)
        assert_close(phi[k], 0, 2e-3);
    assert_identical(grid.stiffness[0], 0);
    mf_potential_grid_clear(&grid);
    mf_curve_clear(&twin.law);
}

/// The known part of a bin that it keeps empty counts no more than 50 k_B T.
static void test_known_part_of_a_bin_has_an_end_when_it_diverges(void **state) {
    (void)state;
    struct twin twin;
    make_twin(&twin);
    assert_close(mf_potential_grid_known(&twin.problem, 0, 2), 50 * temperature, 1e-9);
    assert_close(mf_potential_grid_known(&twin.problem, 0, 22), -temperature * log(twin.target[22]),
                 2e-3);
    twin.problem.known.curves = 0;
    assert_identical(mf_potential_grid_known(&twin.problem, 0, 2), 0);
    mf_curve_clear(&twin.law);
}

/// Samples have both, unless an engine has the known part itself; the cutoff is the larger one.
static void test_table_has_both_parts_when_we_sample(void **state) {
    (void)state;
    struct twin twin;
    struct potential_grid grid;
    struct table both, sought;
    double phi[BINS + 1], value[2], slope[2];
    make_twin(&twin);
    for (int elsewhere = 0; elsewhere < 2; elsewhere++) {
        twin.problem.knows_elsewhere = elsewhere;
        assert_ok(mf_potential_grid_init(&grid, &twin.problem));
        for (int k = 0; k <= BINS; k++)
            phi[k] = 0.3 * (2 - grid.r[k]);
        assert_ok(mf_potential_grid_table(&grid, phi, &both));
        assert_ok(mf_potential_grid_table_sought(&grid, phi, &sought));
        assert_close(sought.cutoff, 2, 1e-12);
        assert_close(both.cutoff, elsewhere ? 2 : 2.5, 1e-12);
        mf_table_evaluate(&both, 1.1, &value[0], &slope[0], NULL);
        mf_table_evaluate(&sought, 1.1, &value[1], &slope[1], NULL);
        assert_close(value[0] - value[1], elsewhere ? 0 : mf_curve_value(&twin.law, 1.1), 1e-5);
        assert_close(slope[1], -0.3, 1e-9);
        mf_table_clear(&both);
        mf_table_clear(&sought);
        mf_potential_grid_clear(&grid);
    }
    mf_curve_clear(&twin.law);
}

/// A soft known part keeps nobody away: the core stays stiff.
static void test_core_is_stiff_when_the_known_part_is_soft(void **state) {
    (void)state;
    struct twin twin;
    struct potential_grid grid;
    struct curve soft;
    make_twin(&twin);
    assert_ok(mf_curve_create(&soft, &mf_formula_gaussian));
    twin.problem.known.curve = &soft;
    assert_ok(mf_potential_grid_init(&grid, &twin.problem));
    assert_identical(grid.stiffness[0], 2000);
    mf_potential_grid_clear(&grid);
    mf_curve_clear(&soft);
    mf_curve_clear(&twin.law);
}

static void test_init_refuses_when_the_known_part_forbids_what_the_target_has(void **state) {
    (void)state;
    struct twin twin;
    struct potential_grid grid;
    make_twin(&twin);
    ((struct formula_lennard_jones_parameters *)twin.law.parameters)->sigma = 1.6;
    assert_int_equal(mf_potential_grid_init(&grid, &twin.problem), STATUS_BAD_INPUT);
    assert_non_null(strstr(mf_status_message(), "scene.known: it is above"));
    mf_curve_clear(&twin.law);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_start_is_zero_when_the_whole_potential_is_known),
        cmocka_unit_test(test_known_part_of_a_bin_has_an_end_when_it_diverges),
        cmocka_unit_test(test_table_has_both_parts_when_we_sample),
        cmocka_unit_test(test_core_is_stiff_when_the_known_part_is_soft),
        cmocka_unit_test(test_init_refuses_when_the_known_part_forbids_what_the_target_has),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
