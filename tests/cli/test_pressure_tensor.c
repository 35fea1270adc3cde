// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pressure along each axis and across: of one pair, whose force is known, in space and in the
// plane; of a fluid, in which all axes are alike; through a restart.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <string.h>

static struct run_program_result result;

static void simulate(struct temporary_folder *folder, const char *scene, const char *out) {
    small_inputs_write(folder, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", out);
    run_program_assert_code(&result, 0);
}

/// Two beads 0.5 apart, in the plane in the direction (0.6, 0.8), in space (0.48, 0.64, 0.6), one
/// through an edge of the box, in a step in which they hardly move: F = 25 (1 - 0.5), so that r_a
/// F_b is 6.25 e_a e_b, and N k_B T/V joins the diagonal. Φ gives F to a few parts in a million.
static void test_a_pair_has_the_tensor_of_its_force(void **state) {
    static const char space[] =
        "{\"box\": [4, 5, 6], \"time_step\": 1e-12, \"temperature\": 0.5,\n"
        "\"particles\": {\"count\": 2, \"placement\": \"file\", \"file\": \"places.tsv\"},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25, \"cutoff\": 1},\n"
        "\"dynamics\": {\"integrator\": \"brownian\"}, \"pressure_tensor\": {},\n"
        "\"measure\": {\"equilibration\": 0, \"samples\": 2, \"every\": 1}}\n";
    static const char plane[] =
        "{\"dimensions\": 2, \"box\": [4, 5], \"time_step\": 1e-12, \"temperature\": 0.5,\n"
        "\"particles\": {\"count\": 2, \"placement\": \"file\", \"file\": \"places.tsv\"},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25, \"cutoff\": 1},\n"
        "\"dynamics\": {\"integrator\": \"brownian\"}, \"pressure_tensor\": {},\n"
        "\"measure\": {\"equilibration\": 0, \"samples\": 2, \"every\": 1}}\n";
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        const double volume = dimensions == 3 ? 120 : 20, carried = 2 * 0.5 / volume;
        const double e[3] = {dimensions == 3 ? 0.48 : 0.6, dimensions == 3 ? 0.64 : 0.8, 0.6};
        const char *const folder = dimensions == 3 ? "space" : "plane";
        char key[64], file[64];
        small_inputs_write(*state, "places.tsv",
                           dimensions == 3 ? "3.9 1.2 3\n0.14 1.52 3.3\n" : "3.9 1.2\n0.2 1.6\n",
                           NULL, NULL);
        simulate(*state, dimensions == 3 ? space : plane, folder);
        snprintf(file, sizeof file, "%s/pressure_tensor.tsv", folder);
        results_assert_table(file, dimensions == 3 ? 7 : 4, 2);
        snprintf(file, sizeof file, "%s/summary.json", folder);
        for (int a = 0; a < dimensions; a++)
            for (int b = a; b < dimensions; b++) {
                snprintf(key, sizeof key, "pressure_tensor.%c%c", "xyz"[a], "xyz"[b]);
                assert_close(results_number(file, key),
                             (a == b ? carried : 0) + 6.25 * e[a] * e[b] / volume, 1e-6);
            }
    }
}

static void test_pressures_of_no_potential_are_refused(void **state) {
    static const char hard[] =
        "{\"dimensions\": 2, \"box\": [12, 12], \"time_step\": 0.1,\n"
        "\"particles\": {\"count\": 50, \"radius\": 0.5}, \"dynamics\": {\"integrator\":\n"
        "\"event-driven\"}, \"pressure_tensor\": {},\n"
        "\"measure\": {\"equilibration\": 1, \"samples\": 2, \"every\": 1}}\n";
    small_inputs_write(*state, "scene.json", hard, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "pressure_tensor: the pressure of \"event-driven\" is not that of "
                                "potentials; leave it out");
}

static const char fluid[] =
    "{\"seed\": 3, \"box\": [5, 5, 5], \"time_step\": 0.02, \"particles\": {\"count\": 375},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"}, \"dissipative\": {\"law\": \"power\"},\n"
    "\"pressure_tensor\": {},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 200, \"every\": 10}}\n";

/// False alarm 1 in 3000.
static void test_axes_of_a_fluid_are_alike(void **state) {
    static const char *const diagonal[] = {"xx", "yy", "zz"}, *const across[] = {"xy", "xz", "yz"};
    double value[2][3], error[2][3], mean = 0;
    simulate(*state, fluid, "out");
    for (int k = 0; k < 3; k++)
        for (int which = 0; which < 2; which++) {
            char key[64];
            const char *const name = (which ? across : diagonal)[k];
            snprintf(key, sizeof key, "pressure_tensor.%s", name);
            value[which][k] = results_number("out/summary.json", key);
            snprintf(key, sizeof key, "pressure_tensor.%s_error", name);
            error[which][k] = results_number("out/summary.json", key);
            mean += which ? 0 : value[0][k] / 3;
        }
    assert_close(mean, results_number("out/summary.json", "pressure"), 1e-6 * mean);
    for (int k = 0; k < 3; k++) {
        assert_close(value[0][k], mean, 4 * error[0][k]);
        assert_close(value[1][k], 0, 4 * error[1][k]);
        assert_true(error[0][k] > 0 && error[0][k] < 0.01 * mean);
    }
    assert_contains(result.err, "pressure along x 23.");
}

static void test_it_goes_on_with_the_same_bits(void **state) {
    static const char *const tables[] = {"pressure_tensor.tsv", NULL};
    simulate(*state, fluid, "whole");
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", tables);
}

int main(void) {
#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, small_inputs_enter_without_gnuplot, small_inputs_leave)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_a_pair_has_the_tensor_of_its_force),
        IN_FOLDER(test_pressures_of_no_potential_are_refused),
        IN_FOLDER(test_axes_of_a_fluid_are_alike),
        IN_FOLDER(test_it_goes_on_with_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
