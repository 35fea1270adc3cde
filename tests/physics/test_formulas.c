// SPDX-License-Identifier: GPL-3.0-or-later
//
// The method "formulas" finds the formula of a known potential from its own g(r).
#include "curves/expression_text.h"
#include "shared/is_close.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char twin[] =
    "{\"seed\": 5, \"box\": [7, 7, 7], \"particles\": {\"count\": 1029}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 1000, \"samples\": 2000, \"every\": 20},\n"
    "\"rdf\": {\"range\": 1, \"bins\": 40}}\n";

static const char fit[] =
    "{\"seed\": 1, \"target\": {\"rdf\": {\"file\": \"target/rdf.tsv\"}},\n"
    "\"scene\": {\"box\": [7, 7, 7], \"particles\": {\"count\": 1029}, \"time_step\": 0.02,\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}},\n"
    "\"method\": {\"name\": \"formulas\", \"nodes\": 9, \"rounds\": 6, \"checks\": 1, "
    "\"samples\": 40, \"every\": 20,\n"
    "\"curve_particles\": 375, \"curve_precision\": 0.003},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 500, \"samples\": 100, \"every\": "
    "20}}\n";

/// The formula that summary.json names.
static struct expression read_formula(void) {
    static const char key[] = "\"formula\":\t\"";
    static char text[20000];
    struct expression expression;
    FILE *file = fopen("out/summary.json", "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    char *formula = strstr(text, key);
    assert_non_null(formula);
    formula += strlen(key);
    *strchr(formula, '"') = '\0';
    print_message("%s\n", formula);
    assert_ok(mf_expression_parse(&expression, formula));
    return expression;
}

/// Groot and Warren's repulsion of a = 25 at ρ = 3: Φ = 12.5 (1 − r)². Seeds 1 to 3 of the fit give
/// 12.6 (1 − r)² twice and (3.53 − 3.53 r)², all of seven nodes, and between r = 0.4 and 1 within
/// 0.05 k_B T of the truth; a ramp of 0.3 k_B T, which g(r) hardly sees, would be 0.2 off at 0.4.
static void test_formulas_finds_soft_repulsion_from_its_g_when_it_is_a_twin(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", twin, NULL, NULL);
    small_inputs_write(*state, "run.json", fit, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "target", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    const struct expression found = read_formula();
    assert_int_equal(found.length, 7);
    for (double r = 0.4; r < 1; r += 0.05)
        assert_close(mf_expression_value(&found, r, NULL) - mf_expression_value(&found, 1, NULL),
                     12.5 * (1 - r) * (1 - r), 0.2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            test_formulas_finds_soft_repulsion_from_its_g_when_it_is_a_twin,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
