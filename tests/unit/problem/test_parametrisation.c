// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/parametrisation.h"

#include "base/names.h"
#include "base/rng.h"
#include "curves/formula.h"
#include "curves/shape.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 40, CORE = 8, POTENTIAL_GENES = 12, WEIGHT_GENES = 10, MAX_POINTS = 256 };

/// A problem with both unknowns, and what it borrows.
struct both {
    double g[BINS];
    struct formula_soft_repulsion_parameters soft;
    struct formula_power_omega_parameters power;
    struct curve potential, omega;
    struct inverse_problem problem;
    struct parametrisation parametrisation;
    double variables[POTENTIAL_GENES + WEIGHT_GENES];
};

static int index_of(const struct shape *shape) {
    for (int k = 0; mf_shapes[k]; k++)
        if (mf_shapes[k] == shape)
            return k;
    return -1;
}

static void begin(struct both *both, bool potential, bool omega) {
    *both = (struct both){.soft = {25, 4}, .power = {3, 1, 0, 1.5}};
    for (int k = CORE; k < BINS; k++)
        both->g[k] = 1;
    both->potential = (struct curve){&mf_formula_soft_repulsion, &both->soft};
    both->omega = (struct curve){&mf_formula_power_omega, &both->power};
    const int bspline = index_of(mf_names_find(mf_shapes, "bspline"));
    both->problem = (struct inverse_problem){
        .targets = {.bins = {0, 0.1, BINS},
                    .target[TARGET_RDF] = {.count = BINS, .value = both->g}},
        .unknown = {{potential,
                     {bspline, POTENTIAL_GENES, -20, 80, 0, 0, {0}, BASE_NONE},
                     {&both->potential},
                     NULL},
                    {omega,
                     {bspline, WEIGHT_GENES, 0, 5, 0.1, 1.5, {0}, BASE_NONE},
                     {&both->omega},
                     NULL}},
        .scene = {.temperature = 1},
        .core_threshold = 1e-3,
        .core_stiffness = 2000};
    assert_ok(mf_parametrisation_init(&both->parametrisation, &both->problem));
    assert_ok(mf_parametrisation_start(&both->parametrisation, both->variables));
}

static void check_curve(const struct both *both, enum unknown_kind kind, const struct curve *start,
                        size_t first, double tolerance) {
    double curve[MAX_POINTS];
    const double *r = mf_unknowns_r(&both->parametrisation.unknowns, kind);
    mf_parametrisation_curve(&both->parametrisation, kind, both->variables, curve);
    for (size_t k = first; k < mf_unknowns_points(&both->parametrisation.unknowns, kind); k++)
        assert_close(curve[k], mf_curve_value(start, r[k]), tolerance);
}

static void test_parametrisation_start_gives_back_both_curves_side_by_side(void **state) {
    (void)state;
    struct both both;
    begin(&both, true, true);
    assert_int_equal(both.parametrisation.variables, POTENTIAL_GENES + WEIGHT_GENES);
    assert_int_equal(both.parametrisation.first[UNKNOWN_OMEGA], POTENTIAL_GENES);
    assert_int_equal(mf_unknowns_points(&both.parametrisation.unknowns, UNKNOWN_POTENTIAL),
                     BINS + 1);
    assert_int_equal(mf_unknowns_points(&both.parametrisation.unknowns, UNKNOWN_OMEGA),
                     OMEGA_POINTS);
    check_curve(&both, UNKNOWN_POTENTIAL, &both.potential, CORE, 0.1);
    check_curve(&both, UNKNOWN_OMEGA, &both.omega, 0, 0.02);
    for (size_t k = 0; k < both.parametrisation.variables; k++)
        assert_true(both.variables[k] >= 0 && both.variables[k] <= 1);
    mf_parametrisation_clear(&both.parametrisation);
}

static void test_parametrisation_start_is_the_same_alone_and_beside_the_other(void **state) {
    (void)state;
    struct both both, alone;
    begin(&both, true, true);
    begin(&alone, false, true);
    assert_int_equal(alone.parametrisation.variables, WEIGHT_GENES);
    assert_int_equal(mf_unknowns_points(&alone.parametrisation.unknowns, UNKNOWN_POTENTIAL), 0);
    for (int k = 0; k < WEIGHT_GENES; k++)
        assert_identical(alone.variables[k], both.variables[POTENTIAL_GENES + k]);
    mf_parametrisation_clear(&alone.parametrisation);
    begin(&alone, true, false);
    assert_int_equal(alone.parametrisation.variables, POTENTIAL_GENES);
    assert_int_equal(mf_unknowns_points(&alone.parametrisation.unknowns, UNKNOWN_OMEGA), 0);
    for (int k = 0; k < POTENTIAL_GENES; k++)
        assert_identical(alone.variables[k], both.variables[k]);
    mf_parametrisation_clear(&alone.parametrisation);
    mf_parametrisation_clear(&both.parametrisation);
}

static void test_parametrisation_start_is_clamped_when_it_leaves_the_range(void **state) {
    (void)state;
    struct both both;
    double curve[OMEGA_POINTS];
    begin(&both, false, true);
    both.power.sigma = 500;
    assert_ok(mf_parametrisation_start(&both.parametrisation, both.variables));
    for (int k = 0; k < WEIGHT_GENES; k++)
        assert_true(both.variables[k] >= 0 && both.variables[k] <= 1);
    assert_close(both.variables[0], 1, 0);
    mf_parametrisation_curve(&both.parametrisation, UNKNOWN_OMEGA, both.variables, curve);
    assert_close(curve[0], 5, 1e-9);
    mf_parametrisation_clear(&both.parametrisation);
}

static void test_parametrisation_start_falls_from_the_middle_when_no_weight_is_given(void **state) {
    (void)state;
    struct both both;
    double curve[OMEGA_POINTS];
    begin(&both, false, true);
    both.problem.unknown[UNKNOWN_OMEGA].start[0] = NULL;
    assert_ok(mf_parametrisation_start(&both.parametrisation, both.variables));
    mf_parametrisation_curve(&both.parametrisation, UNKNOWN_OMEGA, both.variables, curve);
    for (int k = 0; k < OMEGA_POINTS; k++)
        assert_close(curve[k],
                     2.5 * (1 - both.parametrisation.unknowns.omega[UNKNOWN_OMEGA].r[k] / 1.5),
                     0.02);
    mf_parametrisation_clear(&both.parametrisation);
}

/// Without a start of its own a fit begins with the base itself, and a change of coefficients
/// changes the curve as without a base.
static void test_parametrisation_adds_coefficients_to_the_base(void **state) {
    (void)state;
    struct both both;
    double base[MAX_POINTS] = {0}, curve[MAX_POINTS], moved[MAX_POINTS], without[2][MAX_POINTS];
    begin(&both, true, false);
    for (int k = CORE; k < BINS; k++)
        base[k] = 3 * sin(0.7 * k) * (k % 2 ? 1.5 : 1); // as rough as no 12 coefficients are
    for (int step = 0; step < 2; step++) {
        both.variables[3] += 0.1 * step;
        mf_parametrisation_curve(&both.parametrisation, UNKNOWN_POTENTIAL, both.variables,
                                 without[step]);
    }
    both.problem.unknown[UNKNOWN_POTENTIAL].base = base;
    both.problem.unknown[UNKNOWN_POTENTIAL].start[0] = NULL;
    assert_ok(mf_parametrisation_start(&both.parametrisation, both.variables));
    mf_parametrisation_curve(&both.parametrisation, UNKNOWN_POTENTIAL, both.variables, curve);
    both.variables[3] += 0.1;
    mf_parametrisation_curve(&both.parametrisation, UNKNOWN_POTENTIAL, both.variables, moved);
    for (int k = CORE; k < BINS; k++) {
        assert_close(curve[k], base[k], 1e-9);
        assert_close(moved[k] - curve[k], without[1][k] - without[0][k], 1e-9);
    }
    mf_parametrisation_clear(&both.parametrisation);
}

static void test_parametrisation_curve_of_a_weight_is_never_negative(void **state) {
    (void)state;
    struct both both;
    double curve[OMEGA_POINTS];
    size_t zeros = 0;
    begin(&both, false, true);
    both.problem.unknown[UNKNOWN_OMEGA].parameters.minimum = -5;
    mf_parametrisation_clear(&both.parametrisation);
    assert_ok(mf_parametrisation_init(&both.parametrisation, &both.problem));
    for (int k = 0; k < WEIGHT_GENES; k++)
        both.variables[k] = k % 2;
    mf_parametrisation_curve(&both.parametrisation, UNKNOWN_OMEGA, both.variables, curve);
    for (int k = 0; k < OMEGA_POINTS; k++) {
        assert_true(curve[k] >= 0);
        zeros += curve[k] <= 0;
    }
    assert_in_range(zeros, 20, OMEGA_POINTS - 20);
    mf_parametrisation_clear(&both.parametrisation);
}

/// Σ of some matrix M Mᵀ of random numbers.
static void make_covariance(double *covariance, size_t variables) {
    double factor[32 * 32] = {0};
    struct rng_sequence random = mf_rng_sequence_begin(4, RNG_INITIAL, 0, 0);
    for (size_t k = 0; k < variables * variables; k++)
        factor[k] = mf_rng_sequence_uniform(&random) - 0.5;
    for (size_t a = 0; a < variables; a++)
        for (size_t b = 0; b < variables; b++) {
            covariance[a * variables + b] = 0;
            for (size_t c = 0; c < variables; c++)
                covariance[a * variables + b] +=
                    factor[a * variables + c] * factor[b * variables + c];
        }
}

/// The band is what the covariance makes of the curve's derivatives, which differences show.
static void check_band(const struct both *both, enum unknown_kind kind, size_t first) {
    enum { ALL = POTENTIAL_GENES + WEIGHT_GENES };
    static double slope[ALL][MAX_POINTS];
    double covariance[ALL * ALL], zero[MAX_POINTS], error[MAX_POINTS], variables[ALL] = {0};
    double flat[INVERSE_FLAT * MAX_POINTS];
    const size_t points = mf_unknowns_points(&both->parametrisation.unknowns, kind);
    make_covariance(covariance, ALL);
    mf_parametrisation_curve(&both->parametrisation, kind, variables, zero);
    for (int n = 0; n < ALL; n++) {
        variables[n] = 1;
        mf_parametrisation_curve(&both->parametrisation, kind, variables, slope[n]);
        variables[n] = 0;
    }
    assert_ok(
        mf_parametrisation_band(&both->parametrisation, kind, variables, covariance, error, flat));
    for (size_t k = first; k < points; k++) {
        double sum = 0;
        for (int a = 0; a < ALL; a++)
            for (int b = 0; b < ALL; b++)
                sum += (slope[a][k] - zero[k]) * covariance[a * ALL + b] * (slope[b][k] - zero[k]);
        assert_close(error[k], sqrt(fmax(0, sum)), 1e-6);
    }
    for (size_t k = 0; k < first; k++)
        assert_true(isnan(error[k]));
    assert_ok(mf_parametrisation_band(&both->parametrisation, kind, variables, NULL, error, flat));
    for (size_t k = 0; k < points; k++)
        assert_true(isnan(error[k]));
}

static void
test_parametrisation_band_is_the_error_that_the_covariance_gives_the_curve(void **state) {
    (void)state;
    struct both both;
    begin(&both, true, true);
    check_band(&both, UNKNOWN_POTENTIAL, CORE);
    check_band(&both, UNKNOWN_OMEGA, 0);
    mf_parametrisation_clear(&both.parametrisation);
}

static void test_parametrisation_laws_are_those_of_the_scene_when_they_are_known(void **state) {
    (void)state;
    struct both both;
    struct unknowns_laws laws;
    struct table known = {.cutoff = 7};
    double value;
    begin(&both, false, true);
    both.problem.scene.potential = &known;
    assert_ok(mf_parametrisation_laws(&both.parametrisation, both.variables, &laws));
    assert_ptr_equal(laws.table[UNKNOWN_POTENTIAL], &known);
    assert_ptr_equal(laws.table[UNKNOWN_OMEGA], &laws.own.table[UNKNOWN_OMEGA]);
    mf_table_evaluate(laws.table[UNKNOWN_OMEGA], 0.75, &value, NULL, NULL);
    assert_close(value, 1.5, 0.02);
    mf_unknowns_laws_clear(&laws);
    mf_parametrisation_clear(&both.parametrisation);
}

/// What was found of a memory and across pairs is what a simulation of the scene reads; what is
/// known of another mode stays.
static void test_parametrisation_laws_put_friction_that_remembers_into_the_scene(void **state) {
    (void)state;
    struct both both;
    struct unknowns_laws laws;
    struct table known = {.cutoff = 7};
    double curve[OMEGA_POINTS], value;
    begin(&both, false, true);
    mf_parametrisation_clear(&both.parametrisation);
    const enum unknown_kind kinds[] = {UNKNOWN_MEMORY + 1, UNKNOWN_TRANSVERSE};
    struct formula_power_omega_parameters power[] = {{2, 1, 0, 1.5}, {1, 1, 0, 1.5}};
    struct curve start[2];
    for (int k = 0; k < 2; k++) {
        start[k] = (struct curve){&mf_formula_power_omega, &power[k]};
        both.problem.unknown[kinds[k]] = both.problem.unknown[UNKNOWN_OMEGA];
        both.problem.unknown[kinds[k]].start[0] = &start[k];
    }
    both.problem.unknown[UNKNOWN_OMEGA].wanted = false;
    both.problem.scene.memory = (struct pair_memory_law){.modes = 2, .mode = {{&known, 1, 0}}};
    assert_ok(mf_parametrisation_init(&both.parametrisation, &both.problem));
    double variables[2 * WEIGHT_GENES];
    assert_ok(mf_parametrisation_start(&both.parametrisation, variables));
    assert_ok(mf_parametrisation_laws(&both.parametrisation, variables, &laws));
    const struct pair_memory_law *memory = &laws.problem.scene.memory;
    assert_ptr_equal(memory->mode[0].omega, &known);
    const struct table *found[] = {memory->mode[1].omega, memory->transverse};
    for (int k = 0; k < 2; k++) {
        assert_non_null(found[k]);
        mf_parametrisation_curve(&both.parametrisation, kinds[k], variables, curve);
        mf_table_evaluate(found[k], 0.8, &value, NULL, NULL);
        assert_close(value, curve[(OMEGA_POINTS - 1) / 2], 1e-6);
        assert_close(value, mf_curve_value(&start[k], 0.8), 0.02);
    }
    mf_unknowns_laws_clear(&laws);
    mf_parametrisation_clear(&both.parametrisation);
}

/// A formula beside nothing else: of three variables, or of those that are not fixed.
static void begin_power_with(struct both *both, int64_t variables, double sigma, double exponent,
                             double inner_cutoff) {
    *both = (struct both){.power = {2.5, 1.5, 0.4, 1.6}};
    both->omega = (struct curve){&mf_formula_power_omega, &both->power};
    both->problem.unknown[UNKNOWN_OMEGA] = (struct unknown){
        .wanted = true,
        .parameters =
            {INVERSE_CURVE_POWER, variables, 0, 5, 0.1, 1.6, {sigma, exponent, inner_cutoff}, 0},
        .start = {&both->omega}};
    assert_ok(mf_parametrisation_init(&both->parametrisation, &both->problem));
    assert_ok(mf_parametrisation_start(&both->parametrisation, both->variables));
}

static void begin_power(struct both *both) {
    begin_power_with(both, INVERSE_PARAMETERS, NAN, NAN, NAN);
}

static void test_parametrisation_power_is_the_formula_and_starts_at_it(void **state) {
    (void)state;
    struct both both;
    begin_power(&both);
    assert_int_equal(both.parametrisation.variables, INVERSE_PARAMETERS);
    check_curve(&both, UNKNOWN_OMEGA, &both.omega, 0, 1e-12);
    mf_parametrisation_clear(&both.parametrisation);
}

/// The curve is the formula with what is fixed, whatever the variables of the rest are.
static void test_parametrisation_power_holds_what_is_fixed(void **state) {
    (void)state;
    struct both both;
    double curve[OMEGA_POINTS];
    begin_power_with(&both, 1, NAN, 1.5, 0.4);
    assert_int_equal(both.parametrisation.variables, 1);
    check_curve(&both, UNKNOWN_OMEGA, &both.omega, 0, 1e-12);
    both.variables[0] = 0.8; // σ = 4
    mf_parametrisation_curve(&both.parametrisation, UNKNOWN_OMEGA, both.variables, curve);
    for (size_t k = 0; k < OMEGA_POINTS; k++)
        assert_close(curve[k],
                     4 / 2.5 *
                         mf_curve_value(&both.omega,
                                        both.parametrisation.unknowns.omega[UNKNOWN_OMEGA].r[k]),
                     1e-9);
    mf_parametrisation_clear(&both.parametrisation);
    begin_power_with(&both, 2, 2.5, NAN, NAN);
    assert_int_equal(both.parametrisation.variables, 2);
    check_curve(&both, UNKNOWN_OMEGA, &both.omega, 0, 1e-12);
    mf_parametrisation_clear(&both.parametrisation);
}

static void test_parametrisation_parameters_have_the_errors_of_their_genes(void **state) {
    (void)state;
    struct both both;
    struct inverse_parameter found[INVERSE_PARAMETERS];
    const double covariance[4] = {0.01 * 0.01, 0, 0, 0.02 * 0.02};
    begin_power_with(&both, 2, NAN, 1.5, NAN);
    mf_parametrisation_parameters(&both.parametrisation, both.variables, covariance, found);
    assert_close(found[INVERSE_SIGMA].value, 2.5, 1e-12);
    assert_close(found[INVERSE_SIGMA].error, 5 * 0.01, 1e-12);
    assert_close(found[INVERSE_EXPONENT].value, 1.5, 0);
    assert_close(found[INVERSE_EXPONENT].error, 0, 0);
    // Half of the way from 0.1 to 1.6 is one variable's range.
    assert_close(found[INVERSE_INNER_CUTOFF].value, 0.4, 1e-12);
    assert_close(found[INVERSE_INNER_CUTOFF].error, 0.75 * 0.02, 1e-12);
    const struct unknown_parameters *p = &both.problem.unknown[UNKNOWN_OMEGA].parameters;
    assert_null(
        mf_parametrisation_parameter_bound(p, INVERSE_SIGMA, 0.5 * (p->minimum + p->maximum)));
    assert_string_equal(mf_parametrisation_parameter_bound(p, INVERSE_SIGMA, p->minimum),
                        "minimum");
    assert_string_equal(mf_parametrisation_parameter_bound(p, INVERSE_SIGMA, p->maximum),
                        "maximum");
    assert_null(mf_parametrisation_parameter_bound(p, INVERSE_SIGMA, NAN));
    mf_parametrisation_parameters(&both.parametrisation, both.variables, NULL, found);
    assert_true(isnan(found[INVERSE_SIGMA].error));
    mf_parametrisation_clear(&both.parametrisation);
}

static void test_parametrisation_band_of_the_formula_follows_its_genes(void **state) {
    (void)state;
    struct both both;
    double error[OMEGA_POINTS], flat[INVERSE_FLAT * OMEGA_POINTS], covariance[9] = {0};
    begin_power(&both);
    // Only σ is uncertain: the band is the curve itself, scaled.
    covariance[0] = 0.01 * 0.01;
    assert_ok(mf_parametrisation_band(&both.parametrisation, UNKNOWN_OMEGA, both.variables,
                                      covariance, error, flat));
    for (size_t k = 0; k < OMEGA_POINTS; k++)
        assert_close(
            error[k],
            mf_curve_value(&both.omega, both.parametrisation.unknowns.omega[UNKNOWN_OMEGA].r[k]) /
                2.5 * 5 * 0.01,
            1e-9);
    mf_parametrisation_clear(&both.parametrisation);
}

/// Two uncertain variables are two directions: orthogonal, the wider first, and together all of the
/// errors.
static void test_parametrisation_flat_directions_are_principal_components(void **state) {
    (void)state;
    struct both both;
    double error[OMEGA_POINTS], flat[INVERSE_FLAT * OMEGA_POINTS], covariance[9] = {0};
    double all = 0, squares[2] = {0}, product = 0;
    begin_power(&both);
    covariance[0] = 0.01 * 0.01;
    covariance[4] = 0.02 * 0.02;
    assert_ok(mf_parametrisation_band(&both.parametrisation, UNKNOWN_OMEGA, both.variables,
                                      covariance, error, flat));
    for (size_t k = 0; k < OMEGA_POINTS; k++) {
        const double second = flat[OMEGA_POINTS + k];
        all += error[k] * error[k];
        squares[0] += flat[k] * flat[k];
        squares[1] += second * second;
        product += flat[k] * second;
    }
    assert_close((squares[0] + squares[1]) / all, 1, 1e-6);
    assert_true(squares[0] > squares[1] && squares[1] > 0.01 * all);
    assert_close(product / all, 0, 1e-6);
    mf_parametrisation_clear(&both.parametrisation);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parametrisation_start_gives_back_both_curves_side_by_side),
        cmocka_unit_test(test_parametrisation_start_is_the_same_alone_and_beside_the_other),
        cmocka_unit_test(test_parametrisation_start_is_clamped_when_it_leaves_the_range),
        cmocka_unit_test(test_parametrisation_start_falls_from_the_middle_when_no_weight_is_given),
        cmocka_unit_test(test_parametrisation_adds_coefficients_to_the_base),
        cmocka_unit_test(test_parametrisation_curve_of_a_weight_is_never_negative),
        cmocka_unit_test(
            test_parametrisation_band_is_the_error_that_the_covariance_gives_the_curve),
        cmocka_unit_test(test_parametrisation_power_is_the_formula_and_starts_at_it),
        cmocka_unit_test(test_parametrisation_power_holds_what_is_fixed),
        cmocka_unit_test(test_parametrisation_parameters_have_the_errors_of_their_genes),
        cmocka_unit_test(test_parametrisation_band_of_the_formula_follows_its_genes),
        cmocka_unit_test(test_parametrisation_flat_directions_are_principal_components),
        cmocka_unit_test(test_parametrisation_laws_are_those_of_the_scene_when_they_are_known),
        cmocka_unit_test(test_parametrisation_laws_put_friction_that_remembers_into_the_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
