// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "curves/expression_law.h"
#include "curves/expression_text.h"
#include "curves/formula.h"
#include "curves/table.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static struct expression parse(const char *text) {
    struct expression expression;
    assert_ok(mf_expression_parse(&expression, text));
    return expression;
}

static double value(const char *text, double r) {
    const struct expression expression = parse(text);
    return mf_expression_value(&expression, r, NULL);
}

static void assert_prints(const char *text, enum expression_style style, const char *expected) {
    const struct expression expression = parse(text);
    char printed[EXPRESSION_TEXT_SIZE];
    mf_expression_print(&expression, style, printed);
    assert_string_equal(printed, expected);
}

static void assert_simplifies(const char *text, const char *expected) {
    struct expression expression = parse(text);
    char printed[EXPRESSION_TEXT_SIZE];
    mf_expression_simplify(&expression);
    mf_expression_print(&expression, EXPRESSION_PLAIN, printed);
    assert_string_equal(printed, expected);
}

/// 4.184 f(r/0.34) wherever it is asked, also of a formula of 30 nodes, half of them r.
static void test_expression_scale_tells_the_same_formula_in_other_units(void **state) {
    (void)state;
    static const char *const formulas[] = {"4*(1/r^12 - 1/r^6)", "r", "2",
                                           "exp(-r^2)*(1 - r/0.99)^2.5",
                                           "r*r+r*r+r*r+r*r+r*r+r*r+r*r+exp(r)"};
    for (size_t k = 0; k < sizeof formulas / sizeof *formulas; k++) {
        struct expression expression = parse(formulas[k]);
        assert_true(mf_expression_scale(&expression, 0.34, 4.184));
        for (double r = 0.4; r < 0.99; r += 0.1)
            assert_close_relative(mf_expression_value(&expression, 0.34 * r, NULL),
                                  4.184 * value(formulas[k], r), 1e-11);
    }
}

/// The numbers are those of a pocket calculator's rules.
static void test_expression_parse_obeys_the_rules_of_arithmetic_when_evaluated(void **state) {
    (void)state;
    assert_close(value("1 + 2*3", 0), 7, 0);
    assert_close(value("8/4/2", 0), 1, 0);
    assert_close(value("1 - 2 - 3", 0), -4, 0);
    assert_close(value("-2^2", 0), -4, 0);
    assert_close(value("(-2)^2", 0), 4, 0);
    assert_close(value("2*-r", 3), -6, 0);
    assert_close(value("2^3^2", 0), 512, 0);
    assert_close(value("r**2 + .5e1", 3), 14, 0);
    assert_close(value("exp(-r^2)", 1), 0.36787944117144233, 1e-16);
    assert_close(value("12.5*(1 - r/0.99)^2", 0.495), 3.125, 1e-15);
    assert_int_equal(parse("12.5*(1 - r/0.99)^2").length, 9);
    assert_int_equal(mf_expression_depth(&(struct expression){0}), 0);
    const struct expression nested = parse("1 + exp(2*r)");
    assert_int_equal(mf_expression_depth(&nested), 4);
}

/// Values of tables; slopes by differences, on either side of the kinks of min and max.
static void test_expression_knows_functions_when_it_is_evaluated(void **state) {
    (void)state;
    assert_close(value("sqrt(2*r)", 8), 4, 1e-15);
    assert_close(value("log(r)", 10), 2.302585092994046, 1e-15);
    assert_close(value("tanh(r/2)", 1), 0.46211715726000976, 1e-15);
    assert_close(value("erf(r)", 0.5), 0.5204998778130465, 1e-15);
    assert_close(value("min(r, 2 - r)", 1.5), 0.5, 0);
    assert_close(value("max(r, max(1, 2*r))", 0.75), 1.5, 0);
    assert_close(value("2^log(1)", 3), 1, 0);
    static const char *const formulas[] = {"sqrt(1 + r^2)", "log(1 + r)*r",    "tanh(3*r - 2)",
                                           "erf(2*r)/r",    "min(r^2, 1 - r)", "max(r^2, 1 - r)"};
    for (size_t k = 0; k < sizeof formulas / sizeof *formulas; k++) {
        struct expression expression = parse(formulas[k]);
        for (double r = 0.2; r < 1; r += 0.1) {
            const double step = 1e-5;
            double slope;
            mf_expression_value(&expression, r, &slope);
            assert_close(slope,
                         (value(formulas[k], r + step) - value(formulas[k], r - step)) / (2 * step),
                         1e-8);
        }
        assert_true(mf_expression_is_finite(&expression, 0.1, 2, 100, NULL));
        assert_true(mf_expression_scale(&expression, 0.34, 4.184));
        assert_close(mf_expression_value(&expression, 0.34 * 0.7, NULL),
                     4.184 * value(formulas[k], 0.7), 1e-13);
    }
    const struct expression logarithm = parse("log(r - 0.5)"), kink = parse("1/max(r, 0.1)");
    double where;
    assert_false(mf_expression_is_finite(&logarithm, 0, 1, 100, &where));
    assert_false(mf_expression_is_finite(&logarithm, 0.4, 1, 100, NULL));
    assert_true(mf_expression_is_finite(&logarithm, 0.6, 1, 100, NULL));
    assert_true(mf_expression_is_finite(&kink, 0, 1, 100, NULL));
}

static void test_expression_print_writes_functions_in_each_style(void **state) {
    (void)state;
    static const char text[] = "max(erf(2*r), min(tanh(r), log(r + 1)))";
    assert_prints(text, EXPRESSION_PLAIN, text);
    assert_prints(text, EXPRESSION_C, "fmax(erf(2.0*r), fmin(tanh(r), log(r + 1.0)))");
    assert_prints(text, EXPRESSION_LATEX,
                  "\\max\\left(\\operatorname{erf}\\left(2 \\, r\\right), "
                  "\\min\\left(\\tanh\\left(r\\right), \\ln\\left(r + 1\\right)\\right)\\right)");
    assert_prints("sqrt(r)", EXPRESSION_PLAIN, "r^0.5");
    assert_simplifies("log(1)*r + min(2, 3)", "2");
}

static void test_expression_parse_names_the_place_when_a_formula_is_wrong(void **state) {
    (void)state;
    static const char *const wrong[][2] = {
        {"", "character 1: it ends where a number"},
        {"1 +", "character 4: it ends where a number"},
        {"4*(1 - r", "character 9: a \")\" is missing"},
        {"4*x", "character 3: unknown name"},
        {"2 r", "character 3: expected an operator"},
        {"2^r", "character 3: an exponent must be a number"},
        {"exp r", "character 5: expected \"(\" after the name of a function"},
        {"1e999", "character 1: not a decimal number"},
        {"0x10", "character 1: not a decimal number"},
        {"r)", "character 2: expected an operator"},
        {"min(r)", "character 6: expected \",\" and a second argument"},
        {"tanh(r, 1)", "character 7: a \")\" is missing"},
        {"sin(r)", "unknown name: only r, exp, sqrt, log, tanh, erf, min and max are allowed"},
        {"3 + @", "character 5: expected a number, r, a function or \"(\""},
    };
    struct expression expression;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(mf_expression_parse(&expression, wrong[k][0]), STATUS_BAD_INPUT);
        assert_non_null(strstr(mf_status_message(), wrong[k][1]));
    }
    char text[4096] = "";
    memset(text, '(', 1000);
    assert_int_equal(mf_expression_parse(&expression, text), STATUS_BAD_INPUT);
    assert_non_null(strstr(mf_status_message(), "too deeply"));
    for (int k = 0; k < 40; k++)
        strcpy(text + 2 * k, "r+");
    strcpy(text + 80, "r");
    assert_int_equal(mf_expression_parse(&expression, text), STATUS_BAD_INPUT);
    assert_non_null(strstr(mf_status_message(), "too long"));
}

static void test_expression_print_is_what_a_person_writes_when_parsed(void **state) {
    (void)state;
    assert_prints("12.5*(1-r/0.99)^2", EXPRESSION_PLAIN, "12.5*(1 - r/0.99)^2");
    assert_prints("-r*3 - -2*exp(-r)", EXPRESSION_PLAIN, "-r*3 + 2*exp(-r)");
    assert_prints("2*(-3)", EXPRESSION_PLAIN, "2*(-3)");
    assert_prints("r/(2*r)-(1-r)", EXPRESSION_PLAIN, "r/(2*r) - (1 - r)");
    assert_prints("(r^2)^-1.5", EXPRESSION_PLAIN, "(r^2)^-1.5");
    assert_prints("1e-7 + 1000000", EXPRESSION_PLAIN, "1e-07 + 1e+06");
    assert_prints("4*(r^-12 - r^-6)", EXPRESSION_LATEX, "4 \\, \\left(r^{-12} - r^{-6}\\right)");
    assert_prints("-2*r/(1+r)", EXPRESSION_LATEX, "-\\frac{2 \\, r}{1 + r}");
    assert_prints("3e-9*exp(-r^2)", EXPRESSION_LATEX,
                  "3\\cdot 10^{-9} \\, \\exp\\left(-r^{2}\\right)");
    assert_prints("4*(1/r^12 - 1)", EXPRESSION_C, "4.0*(1.0/pow(r, 12.0) - 1.0)");
    assert_prints("1/2*r", EXPRESSION_C, "1.0/2.0*r");
}

static void test_expression_simplify_leaves_nothing_neutral_when_done(void **state) {
    (void)state;
    assert_simplifies("1 + 2*3", "7");
    assert_simplifies("1*r + 0", "r");
    assert_simplifies("r - r", "0");
    assert_simplifies("2*(3*r)", "6*r");
    assert_simplifies("2 + (r + 3)", "r + 5");
    assert_simplifies("(r^2)^3", "r^6");
    assert_simplifies("r*r*r", "r^3");
    assert_simplifies("r/r", "1");
    assert_simplifies("r + r + r", "3*r");
    assert_simplifies("1/r^6", "r^-6");
    assert_simplifies("exp(r)*exp(2*r)", "exp(3*r)");
    assert_simplifies("exp(r + 0)*exp(-r)", "1");
    assert_simplifies("0*exp(r) + r^1", "r");
    assert_simplifies("3*(1 - 2*r)^2", "12*(r - 0.5)^2");
    assert_simplifies("0 - r*(2 - 2)", "0");
}

/// Random formulas of random operators.
static struct expression random_formula(struct rng_sequence *random, int length) {
    struct expression e = {0};
    int open = 0; // values that an operator may join
    while (e.length < length || open > 1) {
        const uint32_t choice = mf_rng_sequence_below(random, 10);
        if (open > 0 && choice == 0) {
            mf_expression_push(&e, EXPRESSION_EXP, 0);
        } else if (open > 0 && choice == 1) {
            static const double exponents[] = {2, 3, -1, -2, 0.5, -6};
            mf_expression_push(&e, EXPRESSION_CONSTANT,
                               exponents[mf_rng_sequence_below(random, 6)]);
            mf_expression_push(&e, EXPRESSION_POWER, 0);
        } else if (open > 1 && (choice < 6 || e.length >= length)) {
            mf_expression_push(
                &e, (enum expression_kind)(EXPRESSION_ADD + mf_rng_sequence_below(random, 4)), 0);
            open--;
        } else {
            const bool number = mf_rng_sequence_below(random, 2) == 0;
            mf_expression_push(&e, number ? EXPRESSION_CONSTANT : EXPRESSION_DISTANCE,
                               number ? (double)mf_rng_sequence_below(random, 5) - 1 : 0);
            open++;
        }
    }
    return e;
}

/// Values stay, slopes are those of differences, printed text reads the same, and no rule makes a
/// formula longer: for 20000 random formulas, each at three places where it is finite.
static void test_expression_keeps_its_values_when_simplified_and_printed(void **state) {
    (void)state;
    struct rng_sequence random = mf_rng_sequence_begin(1, RNG_INITIAL, 0, 0);
    int compared = 0;
    for (int n = 0; n < 20000; n++) {
        const struct expression e =
            random_formula(&random, 1 + (int)mf_rng_sequence_below(&random, 20));
        struct expression simple = e, again;
        char text[EXPRESSION_TEXT_SIZE];
        mf_expression_simplify(&simple);
        assert_true(simple.length <= e.length);
        mf_expression_print(&simple, EXPRESSION_PLAIN, text);
        assert_ok(mf_expression_parse(&again, text));
        for (int k = 0; k < 3; k++) {
            const double r = 0.71 + 0.37 * k;
            double slope, simple_slope;
            const double expected = mf_expression_value(&e, r, &slope);
            if (!mf_expression_is_finite(&e, r - 0.01, r + 0.01, 1, NULL) || fabs(expected) > 1e6)
                continue;
            const double scale = 1e-8 * (1 + fabs(expected));
            assert_close(mf_expression_value(&simple, r, &simple_slope), expected, scale);
            assert_close(mf_expression_value(&again, r, NULL), expected, scale);
            const double step = 1e-6, difference = (mf_expression_value(&e, r + step, NULL) -
                                                    mf_expression_value(&e, r - step, NULL)) /
                                                   (2 * step);
            if (fabs(slope) < 1e4)
                assert_close(slope, difference, 1e-3 * (1 + fabs(slope)));
            compared++;
        }
    }
    assert_true(compared > 20000);
}

static void test_expression_is_finite_finds_a_pole_when_it_lies_between_points(void **state) {
    (void)state;
    double where;
    const struct expression pole = parse("1/(r - 0.5001)"), none = parse("1/(r + 0.1)"),
                            root = parse("(1 - r/0.9)^2.5"), negative = parse("(r - 1)^0.5");
    assert_false(mf_expression_is_finite(&pole, 0, 1, 100, &where));
    assert_close(where, 0.5, 1e-12);
    assert_true(mf_expression_is_finite(&none, 0, 1, 100, NULL));
    assert_true(mf_expression_is_finite(&root, 0, 0.9, 1024, NULL));
    assert_false(mf_expression_is_finite(&negative, 0, 1, 100, &where));
    assert_identical(where, 0);
}

// The law -----------------------------------------------------------------------------------------

static struct curve make(const struct curve_family *family, const char *formula, double inner,
                         double cutoff) {
    struct curve curve;
    assert_ok(mf_curve_create(&curve, family));
    struct expression_parameters *p = curve.parameters;
    snprintf(p->formula, sizeof p->formula, "%s", formula);
    p->inner_cutoff = inner;
    p->cutoff = cutoff;
    return curve;
}

static void test_expression_law_is_lennard_jones_when_it_is_written_down(void **state) {
    (void)state;
    struct curve curve = make(&mf_expression_potential, "4*(1/r^12 - 1/r^6)", 0.5, 2.5), known;
    assert_ok(mf_curve_create(&known, &mf_formula_lennard_jones));
    assert_ok(mf_curve_check(&curve));
    for (int k = 0; k <= 60; k++)
        assert_close_relative(mf_curve_value(&curve, 0.05 * k), mf_curve_value(&known, 0.05 * k),
                              1e-12);
    struct table table;
    double slope;
    assert_ok(mf_table_init_potential(&table, &curve));
    mf_table_evaluate(&table, 1, NULL, &slope, NULL);
    assert_close(slope, -24, 1e-3);
    mf_table_clear(&table);
    mf_curve_clear(&curve);
    mf_curve_clear(&known);
}

static void test_expression_law_is_the_power_law_when_it_is_written_down(void **state) {
    (void)state;
    struct curve curve = make(&mf_expression_omega, "6*(1 - r/1.72)^2", 0.596, 1.72);
    assert_ok(mf_curve_check(&curve));
    const struct formula_power_omega_parameters power = {6, 2, 0.596, 1.72};
    const struct curve known = {&mf_formula_power_omega, (void *)&power};
    for (int k = 0; k <= 40; k++)
        assert_close(mf_curve_value(&curve, 0.05 * k), mf_curve_value(&known, 0.05 * k), 1e-14);
    mf_curve_clear(&curve);
}

static void test_expression_law_is_refused_when_it_is_not_finite(void **state) {
    (void)state;
    static const struct {
        const struct curve_family *family;
        const char *formula;
        double inner, cutoff;
        const char *message;
    } wrong[] = {
        {&mf_expression_potential, "1/r", 0, 1, "near r = 0: below \"inner_cutoff\""},
        {&mf_expression_potential, "1/(r - 0.5)", 0.1, 1, "near r = 0.49"},
        {&mf_expression_potential, "exp(1000*r)", 0, 1, "near r = 0.7"},
        {&mf_expression_potential, "1/r", 1, 1, "the inner_cutoff 1 is not below the cutoff 1"},
        {&mf_expression_potential, "1/", 0, 1, "character 3"},
        {&mf_expression_omega, "r - 0.5", 0, 1, "is negative at r = 0"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        struct curve curve =
            make(wrong[k].family, wrong[k].formula, wrong[k].inner, wrong[k].cutoff);
        assert_int_equal(mf_curve_check(&curve), STATUS_BAD_INPUT);
        assert_non_null(strstr(mf_status_message(), wrong[k].message));
        mf_curve_clear(&curve);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_expression_scale_tells_the_same_formula_in_other_units),
        cmocka_unit_test(test_expression_parse_obeys_the_rules_of_arithmetic_when_evaluated),
        cmocka_unit_test(test_expression_knows_functions_when_it_is_evaluated),
        cmocka_unit_test(test_expression_print_writes_functions_in_each_style),
        cmocka_unit_test(test_expression_parse_names_the_place_when_a_formula_is_wrong),
        cmocka_unit_test(test_expression_print_is_what_a_person_writes_when_parsed),
        cmocka_unit_test(test_expression_simplify_leaves_nothing_neutral_when_done),
        cmocka_unit_test(test_expression_keeps_its_values_when_simplified_and_printed),
        cmocka_unit_test(test_expression_is_finite_finds_a_pole_when_it_lies_between_points),
        cmocka_unit_test(test_expression_law_is_lennard_jones_when_it_is_written_down),
        cmocka_unit_test(test_expression_law_is_the_power_law_when_it_is_written_down),
        cmocka_unit_test(test_expression_law_is_refused_when_it_is_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
