// SPDX-License-Identifier: GPL-3.0-or-later
//
// Genes of a mixture: those of a potential for each kind of pairs, then those of one weight.
#include "problem/decoder.h"

#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 40, PAIRS = 3, EACH = BINS + 1, GENES = 12, WEIGHT_GENES = 10 };
enum { ALL = PAIRS * GENES + WEIGHT_GENES };

static const size_t cores[PAIRS] = {8, 4, 6};

/// Three potentials and a weight, and what the problem borrows.
struct mixture {
    double g[PAIRS * BINS];
    struct formula_soft_repulsion_parameters soft[PAIRS];
    struct formula_power_weight_parameters power;
    struct curve potential[PAIRS], weight;
    struct inverse_problem problem;
    struct decoder decoder;
    double genes[ALL];
};

static void begin(struct mixture *mixture) {
    *mixture = (struct mixture){.soft = {{25, 4}, {40, 4}, {10, 4}}, .power = {3, 1, 0, 1.5}};
    mixture->problem = (struct inverse_problem){
        .targets = {.bins = {0, 0.1, BINS},
                    .target[TARGET_RDF] = {.count = PAIRS * BINS, .value = mixture->g}},
        .unknown = {{true, {INVERSE_CURVE_BSPLINE, GENES, -20, 80, 0, 0}, {NULL}},
                    {true, {INVERSE_CURVE_BSPLINE, WEIGHT_GENES, 0, 5, 0.1, 1.5}, {NULL}}},
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
    mixture->weight = (struct curve){&mf_formula_power_weight, &mixture->power};
    mixture->problem.unknown[UNKNOWN_WEIGHT].start[0] = &mixture->weight;
    assert_ok(mf_decoder_init(&mixture->decoder, &mixture->problem));
    assert_ok(mf_decoder_start(&mixture->decoder, mixture->genes));
}

static void test_decoder_start_gives_back_each_potential_of_a_mixture(void **state) {
    (void)state;
    struct mixture m;
    double curve[PAIRS * EACH], weight[WEIGHT_POINTS];
    begin(&m);
    assert_int_equal(m.decoder.genes, ALL);
    assert_int_equal(m.decoder.first[UNKNOWN_WEIGHT], PAIRS * GENES);
    assert_int_equal(mf_decoder_curve_count(&m.decoder, UNKNOWN_POTENTIAL), PAIRS);
    assert_int_equal(mf_decoder_curve_count(&m.decoder, UNKNOWN_WEIGHT), 1);
    assert_int_equal(mf_decoder_points(&m.decoder, UNKNOWN_POTENTIAL), PAIRS * EACH);
    mf_decoder_curve(&m.decoder, UNKNOWN_POTENTIAL, m.genes, curve);
    for (size_t n = 0; n < PAIRS * EACH; n++) {
        const size_t pair = n / EACH, k = n % EACH;
        assert_int_equal(mf_decoder_fits(&m.decoder, UNKNOWN_POTENTIAL, n),
                         k >= cores[pair] && k < BINS);
        if (k >= cores[pair])
            assert_close(curve[n], mf_curve_value(&m.potential[pair], m.decoder.potential.r[n]),
                         0.1);
    }
    mf_decoder_curve(&m.decoder, UNKNOWN_WEIGHT, m.genes, weight);
    assert_close(weight[WEIGHT_POINTS / 2],
                 mf_curve_value(&m.weight, m.decoder.weight.r[WEIGHT_POINTS / 2]), 0.02);
    mf_decoder_clear(&m.decoder);
}

/// The potentials that are not given start from the mean force, here 0.
static void test_decoder_start_takes_the_mean_force_where_a_potential_is_not_given(void **state) {
    (void)state;
    struct mixture m;
    double curve[PAIRS * EACH];
    begin(&m);
    m.problem.unknown[UNKNOWN_POTENTIAL].start[1] = NULL;
    assert_ok(mf_decoder_start(&m.decoder, m.genes));
    mf_decoder_curve(&m.decoder, UNKNOWN_POTENTIAL, m.genes, curve);
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
    mf_decoder_curve(&m.decoder, UNKNOWN_POTENTIAL, m.genes, before);
    for (size_t gene = 0; gene < ALL; gene++) {
        size_t moved[PAIRS] = {0};
        const double kept = m.genes[gene];
        m.genes[gene] += 0.1;
        mf_decoder_curve(&m.decoder, UNKNOWN_POTENTIAL, m.genes, after);
        m.genes[gene] = kept;
        for (size_t n = 0; n < PAIRS * EACH; n++)
            moved[n / EACH] += !is_identical(before[n], after[n]);
        for (size_t pair = 0; pair < PAIRS; pair++)
            assert_int_equal(moved[pair] > 0, pair == gene / GENES);
    }
    mf_decoder_clear(&m.decoder);
}

/// Only the genes of A-B are uncertain: so is its curve alone. Cores have no error.
static void test_decoder_band_of_a_mixture_is_unknown_in_each_core(void **state) {
    (void)state;
    static double covariance[ALL * ALL];
    struct mixture m;
    double error[PAIRS * EACH], flat[INVERSE_FLAT * PAIRS * EACH];
    begin(&m);
    for (size_t gene = GENES; gene < 2 * GENES; gene++)
        covariance[gene * ALL + gene] = 0.01 * 0.01;
    assert_ok(mf_decoder_band(&m.decoder, UNKNOWN_POTENTIAL, m.genes, covariance, error, flat));
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
    assert_ok(mf_decoder_laws(&m.decoder, m.genes, &laws));
    assert_int_equal(laws.table[UNKNOWN_POTENTIAL]->curves, PAIRS);
    assert_int_equal(laws.table[UNKNOWN_WEIGHT]->curves, 1);
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
    mf_decoder_curve_name(&m.decoder, UNKNOWN_WEIGHT, 0, name);
    assert_string_equal(name, "weight");
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
