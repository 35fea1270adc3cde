// SPDX-License-Identifier: GPL-3.0-or-later
//
// A run file that says no more than target, density and temperature: what the program chooses
// reproduces the target as well as run files made by hand, at the temperature that was asked for.
#include "io/data_table.h"
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static struct run_program_result result;

/// Fit a target with seed 1; `scene` has the members of the scene.
static void fit(void **state, const char *target, const char *scene, char summary[1024]) {
    char text[1024], out[1024], run[1024];
    const int length = snprintf(text, sizeof text,
                                "{\"target\": {\"rdf\": {%s}}, \"scene\": {%s, "
                                "\"temperature\": 1}}",
                                target, scene);
    assert_in_range(length, 1, sizeof text - 1);
    snprintf(run, sizeof run, "%s",
             temporary_folder_write(*state, "run.json", text, (size_t)length));
    snprintf(out, sizeof out, "%s", temporary_folder_file(*state, "out"));
    run_program(&result, &(struct run_program_how){.work_limit = 600},
                (const char *const[]){"fit", run, "-o", out, "--quiet", NULL});
    run_program_assert_code(&result, 0);
    snprintf(summary, 1024, "%.1000s/summary.json", out);
}

/// Kinetic and configurational temperature are right within 1 % and four of their errors, and the
/// rms of g − g* is known within a fifth of it.
static void assert_well_verified(const char *summary) {
    const double rms = results_number(summary, "rdf_rmse"),
                 error = results_number(summary, "rdf_rmse_error"),
                 kinetic = results_number(summary, "temperature"),
                 configurational = results_number(summary, "temperature_configurational");
    print_message("rms of g - g* = %.5f(%.5f), noise %.5f; T = %.4f, %.4f\n", rms, error,
                  results_number(summary, "rdf_noise"), kinetic, configurational);
    assert_true(error < 0.2 * rms);
    assert_true(rms < 3 * results_number(summary, "rdf_noise"));
    assert_true(fabs(kinetic - 1) < 0.01 + 4 * results_number(summary, "temperature_error"));
    assert_true(fabs(configurational - 1) <
                0.01 + 4 * results_number(summary, "temperature_configurational_error"));
}

/// The run file of runs/soft-discs-fit ends at 0.0046(8), 0.0039(7) and so on by its seeds.
static void test_default_fit_of_soft_discs_is_as_good_as_that_by_hand(void **state) {
    char target[1024], folder[512], summary[1024];
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(target, sizeof target,
             "\"file\": \"%s/targets/soft-discs/rdf.tsv\", \"particles\": 1600", folder);
    fit(state, target, "\"dimensions\": 2, \"density\": 0.8", summary);
    assert_well_verified(summary);
    assert_true(results_number(summary, "rdf_rmse") < 0.003);
}

/// In a gas g = exp(−Φ/k_B T) but for terms of the density, ρ ∫ f f, here up to 0.1 with f(r) = g −
/// 1: whatever was chosen, the potential is known beforehand.
static void test_default_fit_of_a_gas_finds_minus_the_logarithm_of_g(void **state) {
    static const double density = 0.1, known = 0.3, tolerance = 0.1;
    char text[8192], summary[1024], scene[64], path[1024];
    struct data_table table;
    double squares = 0, count = 0;
    int length = snprintf(text, sizeof text, "# r[lambda]\tg[1]\tg_error[1]\n");
    for (int k = 0; k < 60; k++) {
        const double r = (k + 0.5) * 0.05;
        length += snprintf(text + length, sizeof text - (size_t)length, "%.4f %.6f 0.004\n", r,
                           exp(-10 * exp(-r * r / 0.25)));
    }
    temporary_folder_write(*state, "rdf.tsv", text, (size_t)length);
    snprintf(scene, sizeof scene, "\"density\": %g", density);
    fit(state, "\"file\": \"rdf.tsv\", \"particles\": 1000000", scene, summary);
    assert_well_verified(summary);
    snprintf(path, sizeof path, "%s", temporary_folder_file(*state, "out/potential.tsv"));
    assert_ok(mf_data_table_read(&table, path, 2));
    for (size_t k = 0; k < table.rows; k++) {
        const double r = table.values[k * table.columns], phi = 10 * exp(-r * r / 0.25);
        if (exp(-phi) < known)
            continue;
        squares += pow(table.values[k * table.columns + 1] - phi, 2);
        count++;
    }
    mf_data_table_clear(&table);
    print_message("rms of Phi - (-ln g): %.4f\n", sqrt(squares / count));
    assert_true(sqrt(squares / count) < tolerance);
}

/// Four beads of one type among many of another: their g(r) has errors of 0.3, and that of the
/// others, which have errors of 0.003, is met nevertheless, by Φ = a (1 − r)²/2.
static void test_default_fit_is_not_held_up_by_few_beads_of_a_type(void **state) {
    static const char scene[] =
        "{\"seed\": 5, \"box\": [4, 4, 4], \"particles\": {\"types\": {\"A\": 188, \"B\": 4}},\n"
        "\"time_step\": 0.04, \"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": "
        "25},\n"
        "\"A-B\": {\"law\": \"soft-repulsion\", \"a\": 15},\n"
        "\"B-B\": {\"law\": \"soft-repulsion\", \"a\": 35}},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
        "\"measure\": {\"equilibration\": 300, \"samples\": 400, \"every\": 10},\n"
        "\"rdf\": {\"range\": 1, \"bins\": 20}}\n";
    char summary[1024], target[1024], file[512], path[1024];
    struct data_table table;
    double squares = 0, count = 0;
    snprintf(file, sizeof file, "%s",
             temporary_folder_write(*state, "scene.json", scene, sizeof scene - 1));
    snprintf(target, sizeof target, "%s", temporary_folder_file(*state, "target"));
    RUN_PROGRAM(&result, "simulate", file, "-o", target, "--quiet");
    run_program_assert_code(&result, 0);
    fit(state,
        "\"A-A\": {\"file\": \"target/rdf_A-A.tsv\"}, \"A-B\": {\"file\": \"target/rdf_A-B.tsv\"}, "
        "\"B-B\": {\"file\": \"target/rdf_B-B.tsv\"}",
        "\"box\": [4, 4, 4], \"particles\": {\"types\": {\"A\": 188, \"B\": 4}}", summary);
    snprintf(path, sizeof path, "%s", temporary_folder_file(*state, "out/potential_A-A.tsv"));
    assert_ok(mf_data_table_read(&table, path, 3));
    for (size_t k = 0; k < table.rows; k++) {
        const double *row = table.values + k * table.columns;
        if (!(row[3] > 0))
            continue;
        squares += pow((row[1] - 12.5 * pow(1 - row[0], 2)) / row[3], 2);
        count++;
    }
    mf_data_table_clear(&table);
    print_message("A-A: rms of Phi - truth in stated errors %.2f\n", sqrt(squares / count));
    assert_true(sqrt(squares / count) < 1.3);
}

#define IN_FOLDER(name)                                                                            \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        LENGTH_ONLY_LONG(IN_FOLDER(test_default_fit_of_soft_discs_is_as_good_as_that_by_hand)),
        IN_FOLDER(test_default_fit_of_a_gas_finds_minus_the_logarithm_of_g),
        IN_FOLDER(test_default_fit_is_not_held_up_by_few_beads_of_a_type),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
