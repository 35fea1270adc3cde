// SPDX-License-Identifier: GPL-3.0-or-later
//
// Three-bead chains of known laws at two temperatures: the fit of both begins with Boltzmann
// inversion of the cold one and finds one set of potentials that meets all targets of both.
#include "io/data_table.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CHAINS                                                                                     \
    "\"molecules\": {\"trimer\": {\"count\": 80, \"chain\": {\"beads\": [\"A\", \"B\", \"A\"],\n"  \
    "  \"bond\": \"backbone\", \"angle\": \"bend\"}}}"
#define SETUP "\"box\": [4.4, 4.4, 4.4], \"time_step\": 0.005, " CHAINS
#define FRICTION "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"

/// The truth; the temperature is replaced.
static const char scene[] =
    "{\"seed\": 11, \"temperature\": 1, " SETUP ",\n"
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.6}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 12, \"angle\": 110}},\n"
    "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 20},\n"
    "  \"A-B\": {\"law\": \"soft-repulsion\", \"a\": 12},\n"
    "  \"B-B\": {\"law\": \"soft-repulsion\", \"a\": 25}},\n" FRICTION ",\n"
    "\"rdf\": {\"range\": 1.2, \"bins\": 24}, \"bond_lengths\": {\"bins\": 60},\n"
    "\"bond_angles\": {\"bins\": 45},\n"
    "\"measure\": {\"equilibration\": 2000, \"samples\": 2400, \"every\": 25}}\n";

#define STATE(name, temperature)                                                                   \
    "\"" name "\": {\"scene\": {\"temperature\": " temperature "},\n"                              \
    " \"target\": {\"rdf\": {\"A-A\": {\"file\": \"" name "/rdf_A-A.tsv\"},\n"                     \
    "   \"A-B\": {\"file\": \"" name "/rdf_A-B.tsv\"}, \"B-B\": {\"file\": \"" name                \
    "/rdf_B-B.tsv\"}},\n"                                                                          \
    "  \"bond_lengths\": {\"backbone\": {\"file\": \"" name "/bond_lengths.tsv\"}},\n"             \
    "  \"bond_angles\": {\"bend\": {\"file\": \"" name "/bond_angles.tsv\"}}}}"
static const char run[] =
    "{\"seed\": 2, \"scene\": {" SETUP ", " FRICTION "},\n"
    "\"states\": {" STATE("cold", "1") ",\n" STATE(
        "hot",
        "1.6") "},\n"
               "\"method\": {\"name\": \"imc\", \"replicas\": 4, \"equilibration\": 100,\n"
               "  \"samples\": 200, \"iterations\": 20, \"precision\": 0.006},\n"
               "\"verification\": {\"replicas\": 4, \"equilibration\": 1000, \"samples\": 300, "
               "\"every\": "
               "25}}\n";

static struct run_program_result result;

/// k of the parabola through U below 4 k_B T, by least squares with the weights exp(−U): U is as
/// well known as there are terms.
/// @param[in] unit  of q, in degrees or 1
static double find_k(const char *file, double unit) {
    enum { COLUMNS = 2 };
    static const double highest = 4;
    struct data_table table;
    double normal[3][4] = {{0}}, lowest = INFINITY, c[3];
    assert_ok(mf_data_table_read(&table, file, COLUMNS));
    for (size_t k = 0; k < table.rows; k++)
        lowest = fmin(lowest, table.values[k * table.columns + 1]);
    const double middle = unit * table.values[table.rows / 2 * table.columns];
    for (size_t k = 0; k < table.rows; k++) {
        const double *row = table.values + k * table.columns, q = unit * row[0] - middle;
        const double terms[4] = {1, q, q * q, row[1]};
        if (row[1] > lowest + highest)
            continue;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 4; j++)
                normal[i][j] += terms[i] * terms[j] * exp(lowest - row[1]);
    }
    mf_data_table_clear(&table);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int n = 3; n >= i && j != i; n--)
                normal[j][n] -= normal[j][i] / normal[i][i] * normal[i][n];
    for (int i = 0; i < 3; i++)
        c[i] = normal[i][3] / normal[i][i];
    return 2 * c[2];
}

/// All targets of a state within 1.7 times their statistics, which the verification has of its own
/// samples and those of the target.
static void assert_met(const char *state) {
    static const char *const targets[] = {"rdf", "bond_lengths", "bond_angles"};
    for (size_t k = 0; k < sizeof targets / sizeof *targets; k++) {
        char rms[64], noise[64];
        snprintf(rms, sizeof rms, "states.%s.%s_rmse", state, targets[k]);
        snprintf(noise, sizeof noise, "states.%s.%s_noise", state, targets[k]);
        const double off =
            results_number("out/summary.json", rms) / results_number("out/summary.json", noise);
        print_message("%s: %s is off by %.2f times its noise\n", state, targets[k], off);
        assert_true(off < 1.7);
    }
}

/// Seeds 2 to 6 had k of bonds from 100.5 to 101.2, k of angles from 11.99 to 12.16, with targets
/// of two thirds of these samples.
static void test_two_temperatures_find_the_laws_of_chains(void **state) {
    static const double bond = 100, angle = 12;
    small_inputs_write(*state, "cold.json", scene, NULL, NULL);
    small_inputs_write(*state, "hot.json", scene, "\"temperature\": 1,", "\"temperature\": 1.6,");
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "cold.json", "-o", "cold");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "hot.json", "-o", "hot");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_met("cold");
    assert_met("hot");
    const double found_bond = find_k("out/bonds_backbone.tsv", 1),
                 found_angle = find_k("out/angles_bend.tsv", M_PI / 180);
    print_message("k of bonds %.2f of %g, of angles %.3f of %g\n", found_bond, bond, found_angle,
                  angle);
    assert_true(fabs(found_bond / bond - 1) < 0.02);
    assert_true(fabs(found_angle / angle - 1) < 0.02);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_two_temperatures_find_the_laws_of_chains,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
