// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` of numbers of the scene: twins whose numbers are known, with errors; and what is
// refused.
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/// The twin: a soft fluid of a = 25 and sigma = 3, its g(r) and mean-square displacement.
static const char soft_fluid[] =
    "{\"seed\": 51, \"box\": [4, 4, 4], \"particles\": {\"count\": 192}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 2500, \"every\": 10},\n"
    "\"rdf\": {\"range\": 1.5, \"bins\": 30},\n"
    "\"motion\": {\"every\": 8, \"lags\": 10, \"origin_every\": 2}}\n";

#define MSD "\"msd\": {\"file\": \"target/motion.tsv\"}"
#define RDF "\"rdf\": {\"file\": \"target/rdf.tsv\"}"
#define SIGMA "\"dissipative.sigma\": {\"minimum\": 1, \"maximum\": 8}"
#define A "\"conservative.a\": {\"minimum\": 10, \"maximum\": 60, \"start\": 50}"
#define NUMBERS "\"unknowns\": {\"numbers\": {" SIGMA "}}"
#define GAUSS_NEWTON "\"name\": \"gauss-newton\", \"iterations\": 14"

/// The scene says sigma = 5: there the fit begins.
static const char fit[] =
    "{\"seed\": 3, \"target\": {" MSD "}, " NUMBERS ",\n"
    "\"scene\": {\"box\": [4, 4, 4], \"particles\": {\"count\": 192}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 5}},\n"
    "\"method\": {" GAUSS_NEWTON ", \"equilibration\": 200, \"samples\": 60,\n"
    "\"every\": 10, \"temperature_tolerance\": 0.5},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 100, \"samples\": 100, \"every\": 10}}";

static struct run_program_result result;

static void write_target(struct temporary_folder *folder) {
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
}

/// Write run.json with up to four pairs of texts replaced, the last followed by NULL.
static void write_fit(struct temporary_folder *folder, const char *const replaced[]) {
    small_inputs_write(folder, "run.json", fit, NULL, NULL);
    for (size_t k = 0; replaced[k]; k += 2) {
        char *text = temporary_folder_read("run.json");
        small_inputs_write(folder, "run.json", text, replaced[k], replaced[k + 1]);
        free(text);
    }
}

/// False alarms: 3 in 1000 for another seed, if the errors are honest.
static void assert_found(const char *name, double truth, double largest_error) {
    const double value = results_parameter("out/summary.json", name, "value");
    const double error = results_parameter("out/summary.json", name, "error");
    if (!(error > 0 && error < largest_error) || !(fabs(value - truth) < 3 * error))
        fail_msg("%s = %g +- %g, not %g", name, value, error, truth);
}

static void run_fit(int code) {
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    run_program_assert_code(&result, code);
}

static void test_fit_finds_sigma_of_a_twin_by_methods_with_and_without_slopes(void **state) {
    static const char *const methods[] = {GAUSS_NEWTON, "\"name\": \"cma-es\", \"rounds\": 8"};
    write_target(*state);
    for (int k = 0; k < 2; k++) {
        write_fit(*state, (const char *const[]){GAUSS_NEWTON, methods[k], NULL});
        run_fit(0);
        assert_found("dissipative.sigma", 3, 0.4);
        assert_contains(result.err, "dissipative.sigma = ");
        assert_null(strstr(result.err, "(at its"));
        // The verification is of the sigma that was found: at 5 the beads diffuse half as fast.
        assert_true(results_number("out/summary.json", "msd_rmse") < 0.06);
        assert_true(results_number("out/summary.json", "diffusion") > 0.21);
        // No curve was fitted.
        assert_int_equal(access("out/potential.tsv", F_OK), -1);
        assert_int_equal(access("out/omega.tsv", F_OK), -1);
    }
}

/// One that goes by single errors finds it, too; so few simulations make no model for an error bar.
static void test_fit_finds_sigma_of_a_twin_by_nlopt(void **state) {
    write_target(*state);
    write_fit(*state, (const char *const[]){GAUSS_NEWTON,
                                            "\"name\": \"nlopt\", \"evaluations\": 25", NULL});
    run_fit(0);
    assert_close(results_parameter("out/summary.json", "dissipative.sigma", "value"), 3, 0.6);
}

static void test_fit_finds_a_of_a_twin_from_its_structure(void **state) {
    write_target(*state);
    write_fit(*state, (const char *const[]){MSD, RDF, SIGMA, A, NULL});
    run_fit(0);
    assert_found("conservative.a", 25, 1.5);
}

/// A setting is that of each simulation of the fit, and of the verification.
static void test_fit_finds_the_temperature_and_verifies_at_it(void **state) {
    write_target(*state);
    write_fit(*state,
              (const char *const[]){SIGMA, "\"temperature\": {\"minimum\": 0.4, \"maximum\": 2}",
                                    "\"sigma\": 5", "\"sigma\": 3", "\"time_step\"",
                                    "\"temperature\": 0.6, \"time_step\"", NULL});
    run_fit(0);
    assert_found("temperature", 1, 0.1);
    const double found = results_parameter("out/summary.json", "temperature", "value");
    assert_close(results_number("out/summary.json", "temperature"), found, 0.03 * found);
}

/// Structure and motion tell a potential's number and a friction's apart.
static void test_fit_finds_two_numbers_side_by_side(void **state) {
    static const char *const methods[] = {
        GAUSS_NEWTON,
        "\"name\": \"pareto\", \"population\": 10, \"generations\": 6",
        "\"name\": \"genetic\", \"population\": 10, \"generations\": 8",
    };
    write_target(*state);
    for (size_t k = 0; k < (length_is_long() ? 3 : 2); k++) {
        write_fit(*state, (const char *const[]){MSD, MSD ", " RDF, SIGMA, SIGMA ", " A,
                                                GAUSS_NEWTON, methods[k], NULL});
        run_fit(0);
        assert_close(results_parameter("out/summary.json", "conservative.a", "value"), 25, 3);
        assert_close(results_parameter("out/summary.json", "dissipative.sigma", "value"), 3, 0.6);
    }
}

/// A number beside a curve: a of the potential with a friction weight of some shape.
static void test_fit_finds_a_number_beside_a_curve(void **state) {
    write_target(*state);
    write_fit(*state,
              (const char *const[]){
                  MSD, MSD ", " RDF, "\"numbers\": {" SIGMA,
                  "\"omega\": {\"curve\": \"power\", \"maximum\": 6, \"fixed\": {\"exponent\": 1, "
                  "\"inner_cutoff\": 0}}, \"numbers\": {" A,
                  ",\n\"dissipative\": {\"law\": \"power\", \"sigma\": 5}", "", NULL});
    run_fit(0);
    assert_found("conservative.a", 25, 2);
    assert_found("sigma", 3, 0.5);
    assert_int_equal(access("out/omega.tsv", F_OK), 0);
}

static void test_fit_says_that_a_number_is_at_its_bound(void **state) {
    write_target(*state);
    write_fit(*state, (const char *const[]){"\"minimum\": 1", "\"minimum\": 4", NULL});
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    assert_in_range(result.code, 0, 1);
    assert_contains(result.err, "dissipative.sigma = 4");
    assert_contains(result.err, " (at its minimum)");
    char *text = temporary_folder_read("out/summary.json");
    assert_non_null(strstr(text, "\"bound\":\t\"minimum\""));
    free(text);
}

static void test_fit_of_numbers_gives_the_same_bits_from_used_and_in_pieces(void **state) {
    static const char *const words[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    static const char *const tables[] = {"history.tsv", "numbers_history.tsv", "used.json", NULL};
    static const char *const keys[] = {"value", "error"};
    write_target(*state);
    write_fit(*state,
              (const char *const[]){GAUSS_NEWTON, "\"name\": \"cma-es\", \"rounds\": 4", NULL});
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "1", "--threads", "1", "--quiet");
    const int code = result.code;
    assert_in_range(code, 0, 1);
    RUN_PROGRAM(&result, "fit", "1/used.json", "-o", "again", "--quiet");
    run_program_assert_code(&result, code);
    results_assert_same("1", "again", tables);
    run_program_in_pieces(code, words);
    results_assert_same("1", "pieces", tables);
    for (int k = 0; k < 2; k++)
        assert_close(results_parameter("pieces/summary.json", "dissipative.sigma", keys[k]),
                     results_parameter("1/summary.json", "dissipative.sigma", keys[k]), 0);
    char *text = temporary_folder_read("1/numbers_history.tsv");
    assert_non_null(strstr(text, "dissipative.sigma["));
    assert_non_null(strstr(text, "dissipative.sigma_error["));
    free(text);
}

/// |<n>| grows with the coupling: simulations with 0.4 and 0.5 have 0.724(12) and 0.796(7). Both
/// targets of one observable have its settings.
static void test_fit_finds_a_coupling_from_the_polar_order(void **state) {
    static const char run[] =
        "{\"seed\": 3, \"target\": {\"polar_order\": {\"value\": 0.75, \"error\": 0.02, \"every\": "
        "20, \"lags\": 5}},\n\"unknowns\": {\"numbers\": "
        "{\"interactions.polar-alignment.coupling\": {\"minimum\": 0.1, \"maximum\": 2, \"start\": "
        "1}}},\n\"scene\": {\"dimensions\": 2, \"box\": [12, 12], \"temperature\": 0.1,\n"
        "\"time_step\": 0.02, \"particles\": {\"count\": 120, \"placement\": \"random\", "
        "\"separation\": 0.5},\n\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 20, "
        "\"cutoff\": 1},\n\"interactions\": {\"self-propulsion\": {\"force\": 1}, "
        "\"polar-alignment\": {\"coupling\": 1, \"range\": 1.5}},\n\"dynamics\": {\"integrator\": "
        "\"brownian\", \"orientation_temperature\": 0.5}},\n\"method\": {\"name\": "
        "\"gauss-newton\", \"iterations\": 6, \"equilibration\": 500,\n\"samples\": 50, \"every\": "
        "20},\n\"verification\": {\"replicas\": 2, \"equilibration\": 500, \"samples\": 100, "
        "\"every\": 20}}\n";
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    assert_true(result.code == 0 || result.code == 1);
    const double coupling =
        results_parameter("out/summary.json", "interactions.polar-alignment.coupling", "value");
    print_message("coupling %.3f\n", coupling);
    assert_true(coupling > 0.34 && coupling < 0.56);
    small_inputs_write(*state, "polarity.tsv", "0 1\n2 0.5\n4 0.3\n", NULL, NULL);
    small_inputs_write(*state, "run.json", run, "\"polar_order\": {",
                       "\"polarity_correlation\": {\"file\": \"polarity.tsv\", \"every\": 10, "
                       "\"lags\": 10}, \"polar_order\": {");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "both");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "polar_order: must have the settings of the previous target");
}

static void test_explain_tells_of_numbers(void **state) {
    write_target(*state);
    write_fit(*state, (const char *const[]){NULL});
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "dissipative.sigma is to be found from 1 to 8");
    assert_contains(result.out, "beginning with 5.");
}

/// A law of one pair type of a mixture, and a number of the integrator.
static void test_explain_tells_of_numbers_of_a_pair_type_and_of_the_integrator(void **state) {
    write_target(*state);
    write_fit(*state, (const char *const[]){
                          SIGMA,
                          "\"conservative.A-B.a\": {\"minimum\": 1, \"maximum\": 80}, "
                          "\"dynamics.lambda\": {\"minimum\": 0.1, \"maximum\": 0.4}",
                          "\"count\": 192", "\"types\": {\"A\": 92, \"B\": 100}",
                          "{\"law\": \"soft-repulsion\", \"a\": 25}",
                          "{\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 25}, \"B-A\": {\"law\": "
                          "\"soft-repulsion\", \"a\": 30}, \"B-B\": {\"law\": \"none\"}},\n"
                          "\"dynamics\": {\"integrator\": \"dpd-verlet\"}",
                          NULL});
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "conservative.A-B.a is to be found from 1 to 80");
    assert_contains(result.out, "beginning with 30.");
    // The scene's is out of the range: the middle.
    assert_contains(result.out,
                    "dynamics.lambda is to be found from 0.1 to 0.4, beginning with 0.25.");
    // The pair in the other order, and both.
    small_inputs_change(*state, "run.json", "conservative.A-B.a", "conservative.B-A.a");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "conservative.A-B.a is to be found from 1 to 80");
    small_inputs_change(*state, "run.json", "\"conservative.B-A.a\":",
                        "\"conservative.A-B.a\": {\"minimum\": 1, \"maximum\": 8}, "
                        "\"conservative.B-A.a\":");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "it stands there as \"conservative.A-B.a\", too");
}

static void test_fit_refuses_numbers_that_cannot_be_found(void **state) {
#define RANGE "\": {\"minimum\": 1, \"maximum\": 2}"
    static const struct {
        const char *from, *to, *words[3];
    } cases[] = {
        {SIGMA,
         "\"dissipative.sgima" RANGE,
         {"unknowns.numbers.dissipative.sgima: the scene has no such number",
          "did you mean \"dissipative.sigma\"?"}},
        {SIGMA,
         "\"particles.count" RANGE,
         {"particles.count: it cannot be found: it is an integer"}},
        {SIGMA,
         "\"particles.separation" RANGE,
         {"particles.separation: it cannot be found: it sets the number"}},
        {SIGMA, "\"box" RANGE, {"numbers.box: it cannot be found: it is several numbers"}},
        {SIGMA, "\"precision" RANGE, {"precision: it cannot be found: it is a choice"}},
        {SIGMA, "\"time_step" RANGE, {"time_step: it cannot be found: targets are measured in"}},
        {SIGMA, "\"skin" RANGE, {"skin: it cannot be found: it changes the speed"}},
        {SIGMA, "\"units.mass" RANGE, {"units.mass: it cannot be found: it converts results"}},
        {"\"maximum\": 8", "\"maximum\": 1", {"sigma.maximum: 1 is not above the minimum 1"}},
        {"\"maximum\": 8", "\"maximum\": 8, \"start\": 9", {"sigma.start: 9 is not between"}},
        {"\"minimum\": 1", "\"minimum\": -1", {"sigma.minimum: -1 is not in the range of"}},
        {", \"maximum\": 8", "", {"dissipative.sigma.maximum"}},
        {"\"maximum\": 8",
         "\"maximum\": 8, \"strat\": 2",
         {"sigma.strat: unknown key", "\"start\""}},
        {SIGMA, "", {"unknowns.numbers: names none"}},
        {SIGMA, "\"dissipative.sigma\": 3", {"dissipative.sigma: expected an object"}},
        {SIGMA,
         "\"conservative.a\": {\"minimum\": -1e308, \"maximum\": 1e308}",
         {"conservative.a.maximum: 1e+308 is too far from the minimum"}},
        {GAUSS_NEWTON, "\"name\": \"imc\"", {"method.name: \"imc\" does not find numbers"}},
        {"\"numbers\": {" SIGMA,
         "\"omega\": {}, \"numbers\": {" SIGMA,
         {"dissipative.sigma: omega is an unknown curve itself"}},
        {SIGMA,
         "\"conservative.cutoff\": {\"minimum\": 1, \"maximum\": 3}",
         {"scene: with conservative.cutoff = 3: "}},
        {SIGMA,
         "\"dissipative.inner_cutoff\": {\"minimum\": 0, \"maximum\": 3}",
         {"numbers.dissipative.inner_cutoff: at ends of the ranges the inner_cutoff 3 is not "
          "below the cutoff 1"}},
        {SIGMA,
         "\"dissipative.inner_cutoff\": {\"minimum\": 0, \"maximum\": 0.9},"
         "\"dissipative.cutoff\": {\"minimum\": 0.8, \"maximum\": 1.5}",
         {"at ends of the ranges the inner_cutoff 0.9 is not below the cutoff 0.8"}},
        {"5}},\n\"method\": {",
         "5},\n\"interactions\": {\"uniform-force\": {\"force\": [1, 0, 0]}}},\n"
         "\"method\": {\"estimator\": \"force\", ",
         {"run.json: method.estimator: \"force\" supports only pair forces"}},
    };
    write_target(*state);
    assert_int_equal(mkdir("out", 0777), 0);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const bool itself = strstr(cases[k].to, "omega") != NULL; // the scene then says no omega
        const bool inversion = strstr(cases[k].to, "imc") != NULL;
        write_fit(*state,
                  (const char *const[]){
                      cases[k].from, cases[k].to,
                      itself ? ",\n\"dissipative\": {\"law\": \"power\", \"sigma\": 5}" : NULL, "",
                      NULL});
        if (inversion) {
            char *text = temporary_folder_read("run.json");
            small_inputs_write(*state, "run.json", text,
                               ", \"equilibration\": 200, \"samples\": 60,\n\"every\": 10, "
                               "\"temperature_tolerance\": 0.5",
                               "");
            free(text);
        }
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
        run_program_assert_refused(&result, "out", cases[k].to, 1, cases[k].words);
    }
}

/// Friction does not change where beads are in equilibrium, which is all that g(r) shows.
static void test_fit_says_that_a_number_is_undetermined(void **state) {
    static const char *const methods[] = {GAUSS_NEWTON, "\"name\": \"cma-es\", \"rounds\": 4"};
    write_target(*state);
    for (int k = 0; k < 2; k++) {
        write_fit(*state, (const char *const[]){MSD, RDF, GAUSS_NEWTON, methods[k], NULL});
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
        assert_contains(result.err,
                        "\ndissipative.sigma: undetermined by the targets, between 1 and 8\n");
        assert_null(strstr(result.err, "dissipative.sigma = "));
        char *text = temporary_folder_read("out/summary.json");
        assert_contains(text, "\"undetermined\":\t\"yes\"");
        free(text);
    }
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_fit_finds_sigma_of_a_twin_by_methods_with_and_without_slopes),
        TEST_WITHOUT_FIGURES(test_fit_finds_sigma_of_a_twin_by_nlopt),
        TEST_WITHOUT_FIGURES(test_fit_finds_a_of_a_twin_from_its_structure),
        TEST_WITHOUT_FIGURES(test_fit_finds_the_temperature_and_verifies_at_it),
        TEST_WITHOUT_FIGURES(test_fit_finds_two_numbers_side_by_side),
        TEST_WITHOUT_FIGURES(test_fit_finds_a_number_beside_a_curve),
        TEST_WITHOUT_FIGURES(test_fit_says_that_a_number_is_at_its_bound),
        TEST_WITHOUT_FIGURES(test_fit_says_that_a_number_is_undetermined),
        TEST_WITHOUT_FIGURES(test_fit_of_numbers_gives_the_same_bits_from_used_and_in_pieces),
        TEST_WITHOUT_FIGURES(test_fit_finds_a_coupling_from_the_polar_order),
        TEST_WITHOUT_FIGURES(test_explain_tells_of_numbers),
        TEST_WITHOUT_FIGURES(test_explain_tells_of_numbers_of_a_pair_type_and_of_the_integrator),
        TEST_WITHOUT_FIGURES(test_fit_refuses_numbers_that_cannot_be_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
