// SPDX-License-Identifier: GPL-3.0-or-later
//
// Variables of a mixture: those of a potential for each pair type, then those of one friction
// weight.
#include "problem/decoder.h"

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
    struct decoder decoder;
    double variables[ALL];
};

static void begin(struct mixture *mixture) {
    *mixture = (struct mixture){.soft = {{25, 4}, {40, 4}, {10, 4}}, .power = {3, 1, 0, 1.5}};
    mixture->problem = (struct inverse_problem){
        .targets = {.bins = {0, 0.1, BINS},
                    .target[TARGET_RDF] = {.count = PAIRS * BINS, .value = mixture->g}},
        .unknown = {{true, {INVERSE_CURVE_BSPLINE, VARIABLES, -20, 80, 0, 0, {0}}, {NULL}},
                    {true, {INVERSE_CURVE_BSPLINE, WEIGHT_GENES, 0, 5, 0.1, 1.5, {0}}, {NULL}}},
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
    assert_ok(mf_decoder_init(&mixture->decoder, &mixture->problem));
    assert_ok(mf_decoder_start(&mixture->decoder, mixture->variables));
}

static void test_decoder_start_gives_back_each_potential_of_a_mixture(void **state) {
    (void)state;
    struct mixture m;
    double curve[PAIRS * EACH], omega[OMEGA_POINTS];
    begin(&m);
    assert_int_equal(m.decoder.variables, ALL);
    assert_int_equal(m.decoder.first[UNKNOWN_OMEGA], PAIRS * VARIABLES);
    assert_int_equal(mf_decoder_curve_count(&m.decoder, UNKNOWN_POTENTIAL), PAIRS);
    assert_int_equal(mf_decoder_curve_count(&m.decoder, UNKNOWN_OMEGA), 1);
    assert_int_equal(mf_decoder_points(&m.decoder, UNKNOWN_POTENTIAL), PAIRS * EACH);
    mf_decoder_curve(&m.decoder, UNKNOWN_POTENTIAL, m.variables, curve);
    for (size_t n = 0; n < PAIRS * EACH; n++) {
        const size_t pair = n / EACH, k = n % EACH;
        assert_int_equal(mf_decoder_fits(&m.decoder, UNKNOWN_POTENTIAL, n),
                         k >= cores[pair] && k < BINS);
        if (k >= cores[pair])
            assert_close(curve[n], mf_curve_value(&m.potential[pair], m.decoder.potential.r[n]),
                         0.1);
    }
    mf_decoder_curve(&m.decoder, UNKNOWN_OMEGA, m.variables, omega);
    assert_close(omega[OMEGA_POINTS / 2],
                 mf_curve_value(&m.omega, m.decoder.omega.r[OMEGA_POINTS / 2]), 0.02);
    mf_decoder_clear(&m.decoder);
}

/// The potentials that are not given start from the mean force, here 0.
static void test_decoder_start_takes_the_mean_force_where_a_potential_is_not_given(void **state) {
    (void)state;
    struct mixture m;
    double curve[PAIRS * EACH];
    begin(&m);
    m.problem.unknown[UNKNOWN_POTENTIAL].start[1] = NULL;
    assert_ok(mf_decoder_start(&m.decoder, m.variables));
    mf_decoder_curve(&m.decoder, UNKNOWN_POTENTIAL, m.variables, curve);
    for (size_t k = cores[1]; k < BINS; k++)
        assert_close(curve[EACH + k], 0, 1e-6);
    assert_close(curve[2 * EACH + 10], mf_curve_value(&m.potential[2], m.decoder.potential.r[10]),
                 0.1);
    mf_decoder_clear(&m.decoder);
}

static void test_decoder_genes_of_a_kind_of_pairs_move_its_curve_alone(void **state) {
    (void)state;
    struct mixture m;
    double before[PAIRS * EACH], after[PAIRS * EACH];
    begin(&m);
    mf_decoder_curve(&m.decoder, UNKNOWN_POTENTIAL, m.variables, before);
    for (size_t variable = 0; variable < ALL; variable++) {
        size_t moved[PAIRS] = {0};
        const double kept = m.variables[variable];
        m.variables[variable] += 0.1;
        mf_decoder_curve(&m.decoder, UNKNOWN_POTENTIAL, m.variables, after);
        m.variables[variable] = kept;
        for (size_t n = 0; n < PAIRS * EACH; n++)
            moved[n / EACH] += !is_identical(before[n], after[n]);
        for (size_t pair = 0; pair < PAIRS; pair++)
            assert_int_equal(moved[pair] > 0, pair == variable / VARIABLES);
    }
    mf_decoder_clear(&m.decoder);
}

/// Only the variables of A-B are uncertain: so is its curve alone. Cores have no error.
static void test_decoder_band_of_a_mixture_is_unknown_in_each_core(void **state) {
    (void)state;
    static double covariance[ALL * ALL];
    struct mixture m;
    double error[PAIRS * EACH], flat[INVERSE_FLAT * PAIRS * EACH];
    begin(&m);
    for (size_t variable = VARIABLES; variable < 2 * VARIABLES; variable++)
        covariance[variable * ALL + variable] = 0.01 * 0.01;
    assert_ok(mf_decoder_band(&m.decoder, UNKNOWN_POTENTIAL, m.variables, covariance, error, flat));
    for (size_t n = 0; n < PAIRS * EACH; n++) {
        const size_t pair = n / EACH, k = n % EACH;
        assert_int_equal(isnan(error[n]), k < cores[pair]);
        assert_int_equal(isnan(flat[n]), k < cores[pair]);
        assert_int_equal(isnan(flat[PAIRS * EACH + n]), k < cores[pair]);
        if (k >= cores[pair] && k < BINS)
            assert_int_equal(error[n] > 0.1, pair == 1);
    }
    mf_decoder_clear(&m.decoder);
}

static void test_decoder_laws_of_a_mixture_are_a_table_of_its_curves(void **state) {
    (void)state;
    struct mixture m;
    struct decoder_laws laws;
    begin(&m);
    assert_ok(mf_decoder_laws(&m.decoder, m.variables, &laws));
    assert_int_equal(laws.table[UNKNOWN_POTENTIAL]->curves, PAIRS);
    assert_int_equal(laws.table[UNKNOWN_OMEGA]->curves, 1);
    for (int pair = 0; pair < PAIRS; pair++) {
        double value;
        mf_table_evaluate_pair(laws.table[UNKNOWN_POTENTIAL], pair, 1.5, &value, NULL, NULL);
        assert_close(value, mf_curve_value(&m.potential[pair], 1.5), 0.1);
    }
    mf_decoder_laws_clear(&laws);
    mf_decoder_clear(&m.decoder);
}

static void test_decoder_curve_name_has_the_kind_of_pairs_in_a_mixture(void **state) {
    (void)state;
    static const char *const names[] = {"potential_A-A", "potential_A-B", "potential_B-B"};
    struct mixture m;
    char name[DECODER_NAME_SIZE];
    begin(&m);
    for (size_t pair = 0; pair < PAIRS; pair++) {
        mf_decoder_curve_name(&m.decoder, UNKNOWN_POTENTIAL, pair, name);
        assert_string_equal(name, names[pair]);
    }
    mf_decoder_curve_name(&m.decoder, UNKNOWN_OMEGA, 0, name);
    assert_string_equal(name, "omega");
    m.problem.scene.composition = mf_composition_of_one(50);
    mf_decoder_curve_name(&m.decoder, UNKNOWN_POTENTIAL, 0, name);
    assert_string_equal(name, "potential");
    mf_decoder_clear(&m.decoder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_decoder_start_gives_back_each_potential_of_a_mixture),
        cmocka_unit_test(test_decoder_start_takes_the_mean_force_where_a_potential_is_not_given),
        cmocka_unit_test(test_decoder_genes_of_a_kind_of_pairs_move_its_curve_alone),
        cmocka_unit_test(test_decoder_band_of_a_mixture_is_unknown_in_each_core),
        cmocka_unit_test(test_decoder_laws_of_a_mixture_are_a_table_of_its_curves),
        cmocka_unit_test(test_decoder_curve_name_has_the_kind_of_pairs_in_a_mixture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
