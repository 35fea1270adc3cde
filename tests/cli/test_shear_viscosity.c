// SPDX-License-Identifier: GPL-3.0-or-later
//
// The shear viscosity from outside: at rest and in a wave, in a restart, in units, as a target.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FLUID                                                                                      \
    "\"box\": [4.64, 4.64, 4.64], \"particles\": {\"count\": 300}, \"time_step\": 0.04,\n"         \
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}"
#define WHITE "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}"
#define MEASURED "\"shear_viscosity\": {\"every\": 2, \"lags\": 40}"
#define MOTION "\"motion\": {\"every\": 5, \"lags\": 20}"
#define PLAN "\"measure\": {\"equilibration\": 200, \"samples\": 100, \"every\": 40}"

static const char scene[] = "{\"seed\": 5, " FLUID ", " WHITE ",\n"
                            "\"memory\": {\"slow\": {\"time\": 0.5, \"omega\": {\"law\": "
                            "\"power\", \"sigma\": 3}}},\n" MEASURED ", " MOTION ", " PLAN "}\n";

static const char *const tables[] = {"shear_viscosity.tsv", "rdf.tsv", "used.json", NULL};

static struct run_program_result result;

static void simulate(struct temporary_folder *folder, const char *from, const char *to,
                     const char *out) {
    small_inputs_write(folder, "scene.json", scene, from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", out);
}

static double inner(const char *folder, const char *object, const char *key) {
    char path[64];
    snprintf(path, sizeof path, "%s/summary.json", folder);
    char *text = temporary_folder_read(path);
    const char *begin = strstr(text, object);
    const char *found = begin ? strstr(begin, key) : NULL;
    assert_non_null(found);
    const double value = strtod(strchr(found + strlen(key), ':') + 1, NULL);
    free(text);
    return value;
}

static void test_viscosity_goes_on_with_the_same_bits(void **state) {
    simulate(*state, NULL, NULL, "whole");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "shear viscosity ");
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", tables);
    RUN_PROGRAM(&result, "simulate", "whole/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("whole", "again", tables);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    assert_contains(result.out, "viscosity                          on ");
}

/// D of an infinite box by hand, from what the summary says.
static void test_viscosity_corrects_the_diffusion_coefficient(void **state) {
    simulate(*state, NULL, NULL, "out");
    const double eta = inner("out", "\"shear_viscosity\"", "\"value\"");
    const double d = inner("out", "\"motion\"", "\"diffusion_msd\"");
    const double infinite = inner("out", "\"motion\"", "\"diffusion_infinite\"");
    const double density = 300 / pow(4.64, 3);
    assert_close(infinite - d, 2.837297 / (6 * M_PI * (eta + density * d) * 4.64), 1e-9);
    simulate(*state, "[4.64, 4.64, 4.64]", "[4.64, 4.64, 5]", "long");
    char *summary = temporary_folder_read("long/summary.json");
    assert_null(strstr(summary, "diffusion_infinite")); // of a cube only
    free(summary);
}

/// k_B T_0 τ/λ³ by hand: 1.380649e-23 J/K · 300 K / (0.7 nm)³ · τ, τ = 0.7 nm sqrt(m/k_B T_0).
static void test_viscosity_is_told_in_millipascal_seconds(void **state) {
    simulate(*state, "{\"seed\": 5",
             "{\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": 9e-26}, \"seed\": 5",
             "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, " mPa s by Green and Kubo");
    const double joule = 1.380649e-23 * 300, metre = 0.7e-9;
    const double unit = joule / pow(metre, 3) * metre * sqrt(9e-26 / joule) * 1e3;
    assert_close_relative(inner("out", "\"shear_viscosity\"", "\"value_mPa_s\""),
                          unit * inner("out", "\"shear_viscosity\"", "\"value\""), 1e-9);
}

/// Intervals have two steps of 0.04. Those at a lag of 0 are the same: the integral up to half an
/// interval is that of half of the first.
static void test_correlation_of_the_stress_stands_at_its_lag(void **state) {
    simulate(*state, NULL, NULL, "out");
    char *text = temporary_folder_read("out/shear_viscosity.tsv"), *at = strchr(text, '\n');
    double row[2][6];
    assert_contains(text, "\tlag[tau]\tstress_correlation[");
    for (int k = 0; k < 12; k++)
        row[k / 6][k % 6] = strtod(at, &at);
    assert_close(row[0][3], 0, 0);
    assert_close(row[1][3], 0.08, 1e-12);
    assert_close(row[0][0], 0.04, 1e-12);
    assert_close_relative(row[0][1], row[0][4] * 0.04, 1e-6);
    assert_close_relative(row[1][1], row[0][4] * 0.04 + row[1][4] * 0.08, 1e-6);
    free(text);
}

static void test_wave_tells_its_flow_and_whether_it_can_be_trusted(void **state) {
    simulate(*state, MEASURED,
             MEASURED ", \"interactions\": {\"shear-wave\": {\"acceleration\": 0.3}}", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, " by a flow of ");
    assert_true(inner("out", "\"shear_viscosity\"", "\"value\"") > 0.5);
    assert_close(inner("out", "\"shear_viscosity\"", "\"wave_number\""), 2 * M_PI / 4.64, 1e-9);
    assert_false(temporary_folder_exists("out/shear_viscosity.tsv"));
    char *summary = temporary_folder_read("out/summary.json");
    assert_null(strstr(summary, "diffusion_infinite")); // the flow is no diffusion
    free(summary);
    simulate(*state, MEASURED,
             MEASURED ", \"interactions\": {\"shear-wave\": {\"acceleration\": 5}}", "hot");
    assert_contains(result.err, "the wave is too strong");
    simulate(*state, MEASURED,
             MEASURED ", \"interactions\": {\"shear-wave\": {\"acceleration\": 0.001}}", "lost");
    assert_contains(result.err, "the wave is lost in its noise");
}

static void test_viscosity_refuses_scenes_that_have_none(void **state) {
    static const struct {
        const char *from, *to, *why;
    } faults[] = {
        {MEASURED, MEASURED ", \"interactions\": {\"uniform-force\": {\"force\": [1, 0, 0]}}",
         "shear_viscosity: \"interactions\" other than \"shear-wave\" do not conserve momentum"},
        {"\"lags\": 40", "\"lags\": 4000", "shear_viscosity: 2000 intervals are fewer than two"},
        {"\"memory\": {\"slow\": {\"time\": 0.5, \"omega\": {\"law\": \"power\", \"sigma\": 3}}},",
         "\"dynamics\": {\"integrator\": \"dpd-vv\"},", "\"dpd-vv\" does not give"},
    };
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        simulate(*state, faults[k].from, faults[k].to, "out");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, faults[k].why);
        assert_false(temporary_folder_exists("out/summary.json"));
    }
}

/// The strength of the friction, 4, from the viscosity that it makes, begun at half of it. A false
/// alarm in 15,000 for another seed, if the errors are honest.
static void test_viscosity_can_be_a_target(void **state) {
    static const char fit[] =
        "{\"seed\": 6, \"target\": {\"shear_viscosity\": {\"value\": %.6f, \"error\": %.6f,\n"
        "\"every\": 2, \"lags\": 40}},\n"
        "\"unknowns\": {\"numbers\": {\"dissipative.sigma\": {\"minimum\": 1, \"maximum\": 7}}},\n"
        "\"scene\": {" FLUID ", \"dissipative\": {\"law\": \"power\", \"sigma\": 2}},\n"
        "\"method\": {\"name\": \"gauss-newton\", \"iterations\": 6, \"equilibration\": 200, "
        "\"samples\": 50, "
        "\"every\": 20},\n"
        "\"verification\": {\"replicas\": 2, \"equilibration\": 200, \"samples\": 50, \"every\": "
        "20}}\n";
    char text[2048];
    small_inputs_write(*state, "scene.json", scene,
                       WHITE ",\n\"memory\": {\"slow\": {\"time\": 0.5, "
                             "\"omega\": {\"law\": \"power\", \"sigma\": 3}}}",
                       "\"dissipative\": {\"law\": \"power\", \"sigma\": 4}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "true");
    run_program_assert_code(&result, 0);
    snprintf(text, sizeof text, fit, inner("true", "\"shear_viscosity\"", "\"value\""),
             inner("true", "\"shear_viscosity\"", "\"error\""));
    small_inputs_write(*state, "fit.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "fit.json", "-o", "fit");
    const double sigma = results_parameter("fit/summary.json", "dissipative.sigma", "value");
    const double error = results_parameter("fit/summary.json", "dissipative.sigma", "error");
    print_message("sigma = %g(%g)\n", sigma, error);
    assert_true(fabs(sigma - 4) < 4 * error);
    assert_true(error < 2);
}

#define TEST(test)                                                                                 \
    cmocka_unit_test_setup_teardown(test, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_viscosity_goes_on_with_the_same_bits),
        TEST(test_viscosity_corrects_the_diffusion_coefficient),
        TEST(test_viscosity_is_told_in_millipascal_seconds),
        TEST(test_correlation_of_the_stress_stands_at_its_lag),
        TEST(test_wave_tells_its_flow_and_whether_it_can_be_trusted),
        TEST(test_viscosity_refuses_scenes_that_have_none),
        TEST(test_viscosity_can_be_a_target),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
