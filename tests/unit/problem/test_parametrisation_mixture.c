// SPDX-License-Identifier: GPL-3.0-or-later
//
// Variables of a mixture: those of a potential for each pair type, then those of one friction
// weight.
#include "problem/parametrisation.h"

#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 40, PAIRS = 3, EACH = BINS + 1, VARIABLES = 12, WEIGHT_GENES = 10 };
enum { ALL = PAIRS * VARIABLES + WEIGHT_GENES };

static const size_t cores[PAIRS] = {8, 4, 6};

/// Three potentials and a friction weight, and what the problem borrows.
struct mixture {
    double g[PAIRS * BINS];
    struct formula_soft_repulsion_parameters soft[PAIRS];
    struct formula_power_omega_parameters power;
    struct curve potential[PAIRS], omega;
    struct inverse_problem problem;
    struct parametrisation parametrisation;
    double variables[ALL];
};

static void begin(struct mixture *mixture) {
    *mixture = (struct mixture){.soft = {{25, 4}, {40, 4}, {10, 4}}, .power = {3, 1, 0, 1.5}};
    mixture->problem = (struct inverse_problem){
        .targets = {.bins = {0, 0.1, BINS},
                    .target[TARGET_RDF] = {.count = PAIRS * BINS, .value = mixture->g}},
        .unknown = {{.wanted = true,
                     .parameters = {.shape = INVERSE_CURVE_BSPLINE,
                                    .coefficients = VARIABLES,
                                    .minimum = -20,
                                    .maximum = 80}},
                    {.wanted = true,
                     .parameters = {.shape = INVERSE_CURVE_BSPLINE,
                                    .coefficients = WEIGHT_GENES,
                                    .maximum = 5,
                                    .inner_cutoff = 0.1,
                                    .cutoff = 1.5}}},
        .scene = {.temperature = 1,
                  .composition = {.types = 2, .count = {20, 30}, .name = {"A", "B"}}},
        .core_threshold = 1e-3,
        .core_stiffness = 2000};
    for (size_t pair = 0; pair < PAIRS; pair++) {
        for (size_t k = cores[pair]; k < BINS; k++)
            mixture->g[pair * BINS + k] = 1;
        mixture->potential[pair] = (struct curve){&mf_formula_soft_repulsion, &mixture->soft[pair]};
        mixture->problem.unknown[UNKNOWN_POTENTIAL].start[pair] = &mixture->potential[pair];
    }
    mixture->omega = (struct curve){&mf_formula_power_omega, &mixture->power};
    mixture->problem.unknown[UNKNOWN_OMEGA].start[0] = &mixture->omega;
    assert_ok(mf_parametrisation_init(&mixture->parametrisation, &mixture->problem));
    assert_ok(mf_parametrisation_start(&mixture->parametrisation, mixture->variables));
}

static void test_parametrisation_start_gives_back_each_potential_of_a_mixture(void **state) {
    (void)state;
    struct mixture m;
    double curve[PAIRS * EACH], omega[OMEGA_POINTS];
    begin(&m);
    assert_int_equal(m.parametrisation.variables, ALL);
    assert_int_equal(m.parametrisation.first[UNKNOWN_OMEGA], PAIRS * VARIABLES);
    assert_int_equal(mf_unknowns_curve_count(&m.parametrisation.unknowns, UNKNOWN_POTENTIAL),
                     PAIRS);
    assert_int_equal(mf_unknowns_curve_count(&m.parametrisation.unknowns, UNKNOWN_OMEGA), 1);
    assert_int_equal(mf_unknowns_points(&m.parametrisation.unknowns, UNKNOWN_POTENTIAL),
                     PAIRS * EACH);
    mf_parametrisation_curve(&m.parametrisation, UNKNOWN_POTENTIAL, m.variables, curve);
    for (size_t n = 0; n < PAIRS * EACH; n++) {
        const size_t pair = n / EACH, k = n % EACH;
        assert_int_equal(mf_unknowns_fits(&m.parametrisation.unknowns, UNKNOWN_POTENTIAL, n),
                         k >= cores[pair] && k < BINS);
        if (k >= cores[pair])
            assert_close(
                curve[n],
                mf_curve_value(&m.potential[pair], m.parametrisation.unknowns.potential.r[n]), 0.1);
    }
    mf_parametrisation_curve(&m.parametrisation, UNKNOWN_OMEGA, m.variables, omega);
    assert_close(omega[OMEGA_POINTS / 2],
                 mf_curve_value(
                     &m.omega, m.parametrisation.unknowns.omega[UNKNOWN_OMEGA].r[OMEGA_POINTS / 2]),
                 0.02);
    mf_parametrisation_clear(&m.parametrisation);
}

/// The potentials that are not given start from the mean force, here 0.
static void
test_parametrisation_start_takes_the_mean_force_where_a_potential_is_not_given(void **state) {
    (void)state;
    struct mixture m;
    double curve[PAIRS * EACH];
    begin(&m);
    m.problem.unknown[UNKNOWN_POTENTIAL].start[1] = NULL;
    assert_ok(mf_parametrisation_start(&m.parametrisation, m.variables));
    mf_parametrisation_curve(&m.parametrisation, UNKNOWN_POTENTIAL, m.variables, curve);
    for (size_t k = cores[1]; k < BINS; k++)
        assert_close(curve[EACH + k], 0, 1e-6);
    assert_close(curve[2 * EACH + 10],
                 mf_curve_value(&m.potential[2], m.parametrisation.unknowns.potential.r[10]), 0.1);
    mf_parametrisation_clear(&m.parametrisation);
}

static void test_parametrisation_genes_of_a_kind_of_pairs_move_its_curve_alone(void **state) {
    (void)state;
    struct mixture m;
    double before[PAIRS * EACH], after[PAIRS * EACH];
    begin(&m);
    mf_parametrisation_curve(&m.parametrisation, UNKNOWN_POTENTIAL, m.variables, before);
    for (size_t variable = 0; variable < ALL; variable++) {
        size_t moved[PAIRS] = {0};
        const double kept = m.variables[variable];
        m.variables[variable] += 0.1;
        mf_parametrisation_curve(&m.parametrisation, UNKNOWN_POTENTIAL, m.variables, after);
        m.variables[variable] = kept;
        for (size_t n = 0; n < PAIRS * EACH; n++)
            moved[n / EACH] += !is_identical(before[n], after[n]);
        for (size_t pair = 0; pair < PAIRS; pair++)
            assert_int_equal(moved[pair] > 0, pair == variable / VARIABLES);
    }
    mf_parametrisation_clear(&m.parametrisation);
}

/// Only the variables of A-B are uncertain: so is its curve alone. Cores have no error.
static void test_parametrisation_band_of_a_mixture_is_unknown_in_each_core(void **state) {
    (void)state;
    static double covariance[ALL * ALL];
    struct mixture m;
    double error[PAIRS * EACH], flat[INVERSE_FLAT * PAIRS * EACH];
    begin(&m);
    for (size_t variable = VARIABLES; variable < 2 * VARIABLES; variable++)
        covariance[variable * ALL + variable] = 0.01 * 0.01;
    assert_ok(mf_parametrisation_band(&m.parametrisation, UNKNOWN_POTENTIAL, m.variables,
                                      covariance, error, flat));
    for (size_t n = 0; n < PAIRS * EACH; n++) {
        const size_t pair = n / EACH, k = n % EACH;
        assert_int_equal(isnan(error[n]), k < cores[pair]);
        assert_int_equal(isnan(flat[n]), k < cores[pair]);
        assert_int_equal(isnan(flat[PAIRS * EACH + n]), k < cores[pair]);
        if (k >= cores[pair] && k < BINS)
            assert_int_equal(error[n] > 0.1, pair == 1);
    }
    mf_parametrisation_clear(&m.parametrisation);
}

static void test_parametrisation_laws_of_a_mixture_are_a_table_of_its_curves(void **state) {
    (void)state;
    struct mixture m;
    struct unknowns_laws laws;
    begin(&m);
    assert_ok(mf_parametrisation_laws(&m.parametrisation, m.variables, &laws));
    assert_int_equal(laws.table[UNKNOWN_POTENTIAL]->curves, PAIRS);
    assert_int_equal(laws.table[UNKNOWN_OMEGA]->curves, 1);
    for (int pair = 0; pair < PAIRS; pair++) {
        double value;
        mf_table_evaluate_pair(laws.table[UNKNOWN_POTENTIAL], pair, 1.5, &value, NULL, NULL);
        assert_close(value, mf_curve_value(&m.potential[pair], 1.5), 0.1);
    }
    mf_unknowns_laws_clear(&laws);
    mf_parametrisation_clear(&m.parametrisation);
}

static void test_parametrisation_curve_name_has_the_kind_of_pairs_in_a_mixture(void **state) {
    (void)state;
    static const char *const names[] = {"potential_A-A", "potential_A-B", "potential_B-B"};
    struct mixture m;
    char name[UNKNOWNS_NAME_SIZE];
    begin(&m);
    for (size_t pair = 0; pair < PAIRS; pair++) {
        mf_unknowns_curve_name(&m.parametrisation.unknowns, UNKNOWN_POTENTIAL, pair, name);
        assert_string_equal(name, names[pair]);
    }
    mf_unknowns_curve_name(&m.parametrisation.unknowns, UNKNOWN_OMEGA, 0, name);
    assert_string_equal(name, "omega");
    m.problem.scene.composition = mf_composition_of_one(50);
    mf_unknowns_curve_name(&m.parametrisation.unknowns, UNKNOWN_POTENTIAL, 0, name);
    assert_string_equal(name, "potential");
    mf_parametrisation_clear(&m.parametrisation);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parametrisation_start_gives_back_each_potential_of_a_mixture),
        cmocka_unit_test(
            test_parametrisation_start_takes_the_mean_force_where_a_potential_is_not_given),
        cmocka_unit_test(test_parametrisation_genes_of_a_kind_of_pairs_move_its_curve_alone),
        cmocka_unit_test(test_parametrisation_band_of_a_mixture_is_unknown_in_each_core),
        cmocka_unit_test(test_parametrisation_laws_of_a_mixture_are_a_table_of_its_curves),
        cmocka_unit_test(test_parametrisation_curve_name_has_the_kind_of_pairs_in_a_mixture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
