// SPDX-License-Identifier: GPL-3.0-or-later
//
// Kirkwood and Buff's integrals of molecules: a liquid of soft trimers by its equation of state,
// and the same liquid with some of its trimers called red.
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>

#define TRIMER(name, count)                                                                        \
    "\"" name "\": {\"count\": " count ", \"exclude\": 0, \"chain\": {\"beads\": [\"A\", \"A\", "  \
    "\"A\"], \"bond\": \"spring\"}}"

/// Box, molecules, and what is measured beside the pressure.
static const char scene[] =
    "{\"seed\": 1, \"box\": [%g, %g, %g], \"time_step\": 0.04,\n"
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 30, \"length\": 0.6}},\n"
    "\"molecules\": {%s},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 8},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, %s\n"
    "\"measure\": {\"equilibration\": 1000, \"samples\": %d, \"every\": 10}}\n";

static const double length = 10, trimers = 500;

/// Standard errors by which a mean may be off beside what is known to be left out: one false alarm
/// in 15,000 values; seeds are fixed.
static const double deviations = 4;

static struct run_program_result result;

/// With a quarter of the samples in short.
static void simulate(struct temporary_folder *folder, double box, const char *molecules,
                     const char *observable, int samples, const char *out) {
    char text[2048];
    samples /= length_is_long() ? 1 : 4;
    snprintf(text, sizeof text, scene, box, box, box, molecules, observable, samples);
    small_inputs_write(folder, "scene.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", out, "--threads", "2");
    run_program_assert_code(&result, 0);
}

static double density(double box) {
    return trimers / pow(box, 3);
}

/// 1 + ρG = k_B T/(dp/dρ) by the pressures at two densities, 10 % above and below: of their chord
/// the curvature is less than 1 %, by a third pressure. The sites of a trimer, at its middle, take
/// less than 2 % off.
static void test_compressibility_of_trimers_is_that_of_their_equation_of_state(void **state) {
    static const double box[2] = {9.7, 10.3}, systematic = 0.03;
    double pressure[2], error[2];
    for (int k = 0; k < 2; k++) {
        simulate(*state, box[k], TRIMER("trimer", "500"), "", 1000, "at_density");
        pressure[k] = results_number("at_density/summary.json", "pressure");
        error[k] = results_number("at_density/summary.json", "pressure_error");
    }
    simulate(*state, length, TRIMER("trimer", "500"), "\"kirkwood_buff\": {\"q_maximum\": 1.6},",
             6000, "compressible");
    const double found = results_number("compressible/summary.json", "compressibility");
    const double noise = results_number("compressible/summary.json", "compressibility_error");
    const double exact = (density(box[0]) - density(box[1])) / (pressure[0] - pressure[1]);
    const double its = exact * hypot(error[0], error[1]) / (pressure[0] - pressure[1]);
    print_message("1 + rho G = %.4f(%.4f), by the pressure %.4f(%.4f)\n", found, noise, exact, its);
    assert_true(noise < (length_is_long() ? 0.03 : 0.06) * exact);
    assert_close(found, exact, systematic * exact + deviations * hypot(noise, its));
}

/// The name of a molecule changes nothing: G of the parts is that of the whole, in each
/// configuration as Σ x_a x_b G_ab, and on the average each by itself.
static void test_integrals_of_molecules_do_not_see_their_names(void **state) {
    static const char *const pairs[] = {"red-red", "red-blue", "blue-blue"};
    static const double part[] = {0.3 * 0.3, 2 * 0.3 * 0.7, 0.7 * 0.7}, systematic = 0.03;
    const char *const observable = "\"kirkwood_buff\": {\"q_maximum\": 1.6},";
    double sum = 0;
    simulate(*state, length, TRIMER("trimer", "500"), observable, 3000, "one");
    simulate(*state, length, TRIMER("red", "150") ", " TRIMER("blue", "350"), observable, 3000,
             "two");
    const double whole = results_number("one/summary.json", "kirkwood_buff");
    const double its = results_number("one/summary.json", "kirkwood_buff_error");
    for (int k = 0; k < 3; k++) {
        char key[64];
        snprintf(key, sizeof key, "kirkwood_buff_%s", pairs[k]);
        const double value = results_number("two/summary.json", key);
        snprintf(key, sizeof key, "kirkwood_buff_error_%s", pairs[k]);
        const double error = results_number("two/summary.json", key);
        print_message("G of %s = %.4f(%.4f), of all %.4f(%.4f)\n", pairs[k], value, error, whole,
                      its);
        assert_true(error < (length_is_long() ? 0.25 : 0.5) * fabs(whole));
        assert_close(value, whole, systematic + deviations * hypot(error, its));
        sum += part[k] * value;
    }
    assert_close(sum, whole, 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_compressibility_of_trimers_is_that_of_their_equation_of_state),
        cmocka_unit_test(test_integrals_of_molecules_do_not_see_their_names),
    };
    return cmocka_run_group_tests(tests, small_inputs_enter_without_gnuplot, small_inputs_leave);
}
