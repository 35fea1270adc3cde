// SPDX-License-Identifier: GPL-3.0-or-later
//
// The covariance of the forces as a target: the friction that it comes from is found again.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BINS = 20 };

/// Particles without potential, whose friction begins far from the target's. Noise is drawn anew at
/// each step, so that samples need not be far apart.
static const char fit[] =
    "{\"seed\": 1, \"target\": {\"force_covariance\": {\"file\": \"kappa.tsv\", \"range\": 1, "
    "\"bins\": 20}},\n"
    "\"unknowns\": {\"numbers\": {\"dissipative.sigma\": {\"minimum\": 1, \"maximum\": 6,\n"
    "\"start\": 1.5}}},\n"
    "\"scene\": {\"box\": [5, 5, 5], \"particles\": {\"count\": 375}, \"time_step\": 0.002,\n"
    "\"dynamics\": {\"integrator\": \"dpd-verlet\"}, \"dissipative\": {\"law\": \"power\",\n"
    "\"sigma\": 2}},\n"
    "\"method\": {\"name\": \"gauss-newton\", \"equilibration\": 10,\n"
    "\"samples\": 100, \"every\": 1, \"temperature_tolerance\": 0.3},\n"
    "\"verification\": {\"replicas\": 1, \"equilibration\": 10, \"samples\": 100, \"every\": 1}}\n";

static struct run_program_result result;

/// ∫ r² [3 (1 − r)]² dr
static double integral(double r) {
    return 9 * (pow(r, 3) / 3 - pow(r, 4) / 2 + pow(r, 5) / 5);
}

/// What the standard friction has without a time step, 2 k_B T ω² = [3 (1 − r)]², as means over
/// the bins by r²; the first, in which pairs are rare, is not known.
static void write_exact(struct temporary_folder *folder) {
    char text[BINS * 64] = "";
    size_t length = 0;
    for (int k = 0; k < BINS; k++) {
        const double begin = (double)k / BINS, end = (k + 1.0) / BINS;
        const double mean = 3 * (integral(end) - integral(begin)) / (pow(end, 3) - pow(begin, 3));
        length += (size_t)snprintf(text + length, sizeof text - length, "%g\t%g\t0.02\n",
                                   (begin + end) / 2, k > 0 ? mean : NAN);
    }
    small_inputs_write(folder, "kappa.tsv", text, NULL, NULL);
}

/// Within four errors, and 0.5 % that the time step makes (measured over eight seeds: −0.3 %).
static void test_friction_is_found_from_its_covariance_of_forces(void **state) {
    write_exact(*state);
    small_inputs_write(*state, "run.json", fit, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 0);
    const double sigma = results_parameter("out/summary.json", "dissipative.sigma", "value");
    const double error = results_parameter("out/summary.json", "dissipative.sigma", "error");
    print_message("sigma = %g(%g)\n", sigma, error);
    assert_true(error > 0 && error < 0.05);
    assert_true(fabs(sigma - 3 / sqrt(2)) < 4 * error + 0.005 * sigma);
    results_assert_table("out/force_covariance.tsv", 5, BINS);
    results_assert_number("out/used.json", "target.force_covariance.bins", BINS);
}

static void test_force_covariance_says_what_its_target_lacks(void **state) {
    static const struct {
        const char *from, *to, *why;
    } faults[] = {
        {"dpd-verlet", "aboba", "\"aboba\" splits friction and noise off the forces"},
        {"\"range\": 1", "\"range\": 1.2", "the range 1.2 exceeds 1, that of the forces"},
        {"kappa.tsv", "nothing.tsv", "nothing.tsv: all values are nan"},
        {"kappa.tsv", "negative.tsv", "negative.tsv:2: column 3: -1 is not a standard error"},
        {"kappa.tsv", "narrow.tsv", "narrow.tsv:1: 1 columns, at least 2 are needed"},
    };
    write_exact(*state);
    small_inputs_write(*state, "nothing.tsv", "0.1 nan 1\n0.2 3 nan\n", NULL, NULL);
    small_inputs_write(*state, "negative.tsv", "0.1 nan 1\n0.2 3 -1\n", NULL, NULL);
    small_inputs_write(*state, "narrow.tsv", "0.1\n0.2\n", NULL, NULL);
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        small_inputs_write(*state, "run.json", fit, faults[k].from, faults[k].to);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, faults[k].why);
    }
}

#define TEST(test)                                                                                 \
    cmocka_unit_test_setup_teardown(test, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_friction_is_found_from_its_covariance_of_forces),
        TEST(test_force_covariance_says_what_its_target_lacks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
