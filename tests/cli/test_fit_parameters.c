// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` of a friction weight that is a formula: its parameters with errors, some of them
// held fixed.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/// A soft fluid with a known friction, whose mean-square displacement and D are the targets.
static const char soft_fluid[] =
    "{\"seed\": 51, \"box\": [4, 4, 4], \"particles\": {\"count\": 192}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 4000, \"every\": 10},\n"
    "\"motion\": {\"every\": 8, \"lags\": 10, \"origin_every\": 2}}\n";

#define MSD "\"msd\": {\"file\": \"target/motion.tsv\"}"
#define FIXED "\"fixed\": {\"exponent\": 1, \"inner_cutoff\": 0}"
#define GAUSS_NEWTON "\"name\": \"gauss-newton\", \"iterations\": 12"

static const char fit[] =
    "{\"seed\": 3, \"target\": {" MSD "},\n"
    "\"unknowns\": {\"omega\": {\"curve\": \"power\", \"maximum\": 6, " FIXED "}},\n"
    "\"scene\": {\"box\": [4, 4, 4], \"particles\": {\"count\": 192}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}},\n"
    "\"method\": {" GAUSS_NEWTON ", \"equilibration\": 200, \"samples\": 60,\n"
    "\"every\": 10, \"temperature_tolerance\": 0.5},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 100, \"samples\": 100, \"every\": 10}}";

static struct run_program_result result;

static void write_target(struct temporary_folder *folder) {
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
}

/// The line "T = 1.0107(18), configurational 1.0009(38), pressure 2.9184(22)" has the numbers of
/// `summary.json`, each with an error.
static void assert_says_thermodynamics_with_errors(void) {
    static const char *const names[] = {"temperature", "temperature_configurational", "pressure"};
    double value[3], error[3];
    const char *line = strstr(result.err, "\nT = ");
    assert_non_null(line);
    assert_int_equal(sscanf(line, "\nT = %lf(%lf), configurational %lf(%lf), pressure %lf(%lf)",
                            &value[0], &error[0], &value[1], &error[1], &value[2], &error[2]),
                     6);
    for (int k = 0; k < 3; k++) {
        char key[64];
        snprintf(key, sizeof key, "%s_error", names[k]);
        const double of_summary = results_number("out/summary.json", key);
        assert_true(error[k] > 0);
        assert_true(fabs(value[k] - results_number("out/summary.json", names[k])) < of_summary);
    }
}

/// False alarms: 3 in 1000 for another seed, if the errors are honest.
static void test_fit_finds_a_known_sigma_within_its_error(void **state) {
    write_target(*state);
    small_inputs_write(*state, "run.json", fit, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "(at its"));
    assert_contains(result.err, "error of the fit: ");
    assert_contains(result.err, " rms, error ");
    assert_contains(result.err, ", changed by ");
    assert_contains(result.err, "omega: sigma = ");
    assert_says_thermodynamics_with_errors();
    assert_true(results_number("out/summary.json", "start.error") > 0);
    assert_true(results_number("out/summary.json", "error") > 0);
    assert_contains(result.err, "exponent = 1 (fixed)");
    const double sigma = results_parameter("out/summary.json", "sigma", "value");
    const double error = results_parameter("out/summary.json", "sigma", "error");
    assert_true(error > 0.01 && error < 0.3);
    assert_true(fabs(sigma - 3) < 3 * error);
    assert_close(results_parameter("out/summary.json", "exponent", "value"), 1, 0);
    assert_true(isnan(results_parameter("out/summary.json", "exponent", "error")));
    assert_close(results_parameter("out/summary.json", "inner_cutoff", "value"), 0, 0);
}

/// A sigma of 3 is asked for of a range from 4 to 6: the fit ends there and says so.
static void test_fit_says_that_a_parameter_is_at_its_bound(void **state) {
    write_target(*state);
    small_inputs_write(*state, "run.json", fit, "\"maximum\": 6", "\"minimum\": 4, \"maximum\": 6");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    assert_in_range(result.code, 0, 1);
    assert_contains(result.err, "omega: sigma = 4");
    assert_contains(result.err, " (at its minimum), exponent = 1 (fixed)");
    char *text = temporary_folder_read("out/summary.json");
    char *bound = strstr(text, "\"bound\":\t\"minimum\"");
    assert_non_null(bound);
    // One of the three parameters: a fixed one has no bounds.
    assert_null(strstr(bound + 1, "\"bound\""));
    free(text);
}

static void
test_fit_with_fixed_parameters_gives_the_same_bits_from_used_and_in_pieces(void **state) {
    static const char *const words[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    static const char *const tables[] = {"history.tsv", "omega.tsv", "used.json", NULL};
    write_target(*state);
    small_inputs_write(*state, "run.json", fit, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "1", "--threads", "1", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "1/used.json", "-o", "again", "--quiet");
    run_program_assert_code(&result, 0);
    results_assert_same("1", "again", tables);
    run_program_in_pieces(0, words);
    results_assert_same("1", "pieces", tables);
    static const char *const keys[] = {"value", "error"};
    for (int k = 0; k < 2; k++)
        assert_close(results_parameter("pieces/summary.json", "sigma", keys[k]),
                     results_parameter("1/summary.json", "sigma", keys[k]), 0);
}

/// Each replica of the verification is one window long: only their scatter tells of the error.
static void test_diffusion_of_a_verification_has_an_error(void **state) {
    write_target(*state);
    small_inputs_write(*state, "run.json", fit, "\"samples\": 100", "\"samples\": 8");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 0);
    const double error = results_number("out/summary.json", "diffusion_error");
    assert_true(error > 1e-5 && error < 0.1);
    assert_contains(result.err, ", the slope of the MSD from 0.8 to 1.6 tau");
    results_assert_number("out/summary.json", "diffusion_fit_begin", 0.8);
    results_assert_number("out/summary.json", "diffusion_fit_end", 1.6);
}

/// A D is that of its window: the slope of the MSD over the second half, the window being cut into
/// whole steps whatever the time step is.
static void test_diffusion_is_that_of_its_own_window(void **state) {
    static const char given[] = "\"diffusion\": {\"value\": 0.233, \"window\": 1.02}";
    write_target(*state);
    small_inputs_write(*state, "run.json", fit, MSD, given);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    assert_close(results_number("out/summary.json", "diffusion_fit_end"), 1.02, 1e-12);
    assert_close(results_number("out/summary.json", "diffusion_fit_begin"), 0.51, 0.021);
    small_inputs_write(*state, "run.json", fit, MSD,
                       MSD ", \"diffusion\": {\"value\": 0.233, \"window\": 1.02}");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "other");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "target.diffusion: ");
    assert_contains(result.err, "\"window\"");
}

static void test_every_method_fits_sigma_alone(void **state) {
    static const char *const methods[] = {
        "\"name\": \"cma-es\", \"rounds\": 3",
        "\"name\": \"genetic\", \"population\": 6, \"generations\": 3",
        "\"name\": \"nlopt\", \"evaluations\": 12",
        "\"name\": \"pareto\", \"population\": 8, \"generations\": 2",
    };
    write_target(*state);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        small_inputs_write(*state, "run.json", fit, GAUSS_NEWTON, methods[k]);
        char *text = temporary_folder_read("run.json");
        if (strstr(methods[k], "pareto")) // which wants two targets
            small_inputs_write(*state, "run.json", text, MSD,
                               MSD ", \"diffusion\": {\"value\": 0.233}");
        free(text);
        RUN_PROGRAM(&result, "fit", "run.json", "--force", "-o", "out", "--quiet");
        assert_in_range(result.code, 0, 1); // 1: so few simulations need not converge
        const double sigma = results_parameter("out/summary.json", "sigma", "value");
        assert_true(sigma > 2 && sigma < 4);
        assert_close(results_parameter("out/summary.json", "exponent", "value"), 1, 0);
    }
}

static void test_fit_refuses_what_cannot_be_fixed(void **state) {
    static const struct {
        const char *from, *to, *words[3];
    } cases[] = {
        {FIXED, "\"fixed\": {\"exponnt\": 1}", {"fixed.exponnt: unknown key", "\"exponent\""}},
        {FIXED, "\"fixed\": {\"sigma\": -1}", {"fixed.sigma: -1 is out of range"}},
        {FIXED, "\"fixed\": {\"inner_cutoff\": 1}", {"fixed.inner_cutoff: 1 is not between"}},
        {FIXED,
         "\"fixed\": {\"sigma\": 3, \"exponent\": 1, \"inner_cutoff\": 0}",
         {"omega.fixed: with all of its parameters fixed"}},
        {"\"power\"", "\"bspline\"", {"omega.fixed: only \"curve\": \"power\""}},
        {FIXED, FIXED ", \"coefficients\": 3", {"omega.coefficients: the curve \"power\" has 1"}},
    };
    write_target(*state);
    assert_int_equal(mkdir("out", 0777), 0);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "run.json", fit, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
        run_program_assert_refused(&result, "out", cases[k].to, 1, cases[k].words);
    }
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_fit_finds_a_known_sigma_within_its_error),
        TEST_WITHOUT_FIGURES(test_fit_says_that_a_parameter_is_at_its_bound),
        TEST_WITHOUT_FIGURES(
            test_fit_with_fixed_parameters_gives_the_same_bits_from_used_and_in_pieces),
        TEST_WITHOUT_FIGURES(test_diffusion_of_a_verification_has_an_error),
        TEST_WITHOUT_FIGURES(test_diffusion_is_that_of_its_own_window),
        TEST_WITHOUT_FIGURES(test_every_method_fits_sigma_alone),
        TEST_WITHOUT_FIGURES(test_fit_refuses_what_cannot_be_fixed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
