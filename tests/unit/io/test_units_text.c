// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units_scale.h"
#include "io/units_text.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <string.h>

static bool parses(const char *text) {
    struct units_text unit;
    return mf_units_text_parse(&unit, text, 3);
}

static void test_units_text_parse_takes_what_tables_and_engines_write(void **state) {
    (void)state;
    static const char *const good[] = {"lambda",          "k_B T_0/lambda^d",  "k_B.T_0.mu/tau",
                                       "k_BT_0/lambda^3", "sqrt(mu/tau)",      "1/tau",
                                       "kJ/(mol nm)",     "kcal/mol/angstrom", "nm^-3",
                                       "\xc3\x85/fs",     "standard errors",   ""};
    for (size_t k = 0; k < sizeof good / sizeof *good; k++)
        assert_true(parses(good[k]));
}

static void test_units_text_parse_refuses_what_is_no_unit(void **state) {
    (void)state;
    static const char *const bad[] = {"parsec",  "nm/",  "/nm",   "nm^",    "nm^x",
                                      "sqrt(nm", "(nm",  "nm)",   "10",     "nm^99",
                                      "sqrt",    "((((", "k_B T", "nm nm;", "lambda^d^d"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_false(parses(bad[k]));
    char deep[256];
    memset(deep, '(', sizeof deep - 1);
    deep[sizeof deep - 1] = '\0';
    assert_false(parses(deep));
}

/// 1 kJ = 1e3 kg m²/s² over a mole of as many as Avogadro says.
static void test_units_text_parse_finds_factor_and_exponents(void **state) {
    (void)state;
    struct units_text unit;
    assert_true(mf_units_text_parse(&unit, "kJ/mol/nm^2", 3));
    assert_close_relative(unit.factor, 1e3 / 6.02214076e23 / 1e-18, 1e-14);
    assert_close(unit.exponent[UNITS_METRE], 0, 0);
    assert_close(unit.exponent[UNITS_SECOND], -2, 0);
    assert_close(unit.exponent[UNITS_KILOGRAM], 1, 0);
    assert_true(mf_units_text_parse(&unit, "sqrt(mu/tau)/lambda^d", 2));
    assert_close(unit.exponent[UNITS_MU], 0.5, 0);
    assert_close(unit.exponent[UNITS_TAU], -0.5, 0);
    assert_close(unit.exponent[UNITS_LAMBDA], -2, 0);
}

static void test_units_text_finds_the_brackets_of_headings(void **state) {
    (void)state;
    size_t length;
    assert_string_equal(mf_units_text_in_brackets("survival(r0=0.3)[1]", &length), "1]");
    assert_int_equal(length, 1);
    assert_null(mf_units_text_in_brackets("step", &length));
    assert_null(mf_units_text_in_brackets("r[nm", &length));
    assert_null(mf_units_text_in_brackets("r[nm]x", &length));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_units_text_parse_takes_what_tables_and_engines_write),
        cmocka_unit_test(test_units_text_parse_refuses_what_is_no_unit),
        cmocka_unit_test(test_units_text_parse_finds_factor_and_exponents),
        cmocka_unit_test(test_units_text_finds_the_brackets_of_headings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
