// SPDX-License-Identifier: GPL-3.0-or-later
//
// What an inversion writes of each of its iterations: energy, acceptance, S − S*.
#include "io/data_table.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const tables[] = {"history.tsv", "rdf_now.tsv", "excess_history.tsv",
                                     "potential.tsv", NULL};

static struct run_program_result result;

/// Write and run a fit whose method is `method`, as JSON.
static void run_fit(struct temporary_folder *folder, const char *method, const char *words[3]) {
    static const char old[] = "\"method\": {\"name\": \"imc\", \"replicas\": 2, "
                              "\"equilibration\": 1, \"samples\": 8,\n"
                              "             \"every\": 1, \"iterations\": 1}";
    small_inputs_write(folder, "run.json", small_inputs_run, old, method);
    char *text = temporary_folder_read("run.json");
    small_inputs_write(folder, "run.json", text,
                       "{\"replicas\": 1, \"equilibration\": 1, \"samples\": 2",
                       "{\"replicas\": 4, \"equilibration\": 500, \"samples\": 200");
    free(text);
    small_inputs_write(folder, "target.tsv", small_inputs_target, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet", "--force", "-o", words[0], words[1],
                words[2]);
    assert_in_range(result.code, 0, 1);
}

static void read_table(struct data_table *table, const char *file) {
    assert_ok(mf_data_table_read(table, file, 1));
}

/// The number of a column in a row that counts from the last, 0.
static double last(const struct data_table *table, const char *column, size_t before) {
    const size_t k = mf_data_table_find(table, column);
    assert_true(k > 0 && before < table->rows);
    return table->values[(table->rows - 1 - before) * table->columns + k - 1];
}

/// The rms of g − g* stands in the history, too, where the method has summed it by itself.
static void test_samples_of_the_last_iteration_have_the_rms_of_the_history(void **state) {
    struct data_table now, history;
    run_fit(*state, "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"iterations\": 1}",
            (const char *[]){"out", "--threads", "1"});
    read_table(&now, "out/rdf_now.tsv");
    read_table(&history, "out/history.tsv");
    double sum = 0, errors = 0;
    for (size_t k = 0; k < now.rows; k++) {
        const double *row = now.values + k * now.columns;
        sum += pow(row[2] - row[1], 2);
        errors += row[3] * row[3];
        assert_true(row[4] * (row[2] - row[1]) >= 0);
    }
    const double rms = last(&history, "rdf_rms", 0);
    assert_true(rms > 0);
    assert_true(fabs(sqrt(sum / (double)now.rows) - rms) < 1e-6 * rms);
    assert_true(errors > 0 && sqrt(errors / (double)now.rows) < 1);
    mf_data_table_clear(&now);
    mf_data_table_clear(&history);
}

/// After one iteration the best potential is the one that was sampled, and the verification moves
/// the particles of the scene by dynamics: the same energy of a particle within 5 standard errors,
/// false alarms below 1 in 10^6.
static void test_energy_is_that_of_the_verification(void **state) {
    static const char *const samplers[] = {"monte-carlo", "dynamics"};
    for (size_t k = 0; k < 2; k++) {
        struct data_table history;
        char method[160];
        snprintf(method, sizeof method,
                 "\"method\": {\"name\": \"imc\", \"iterations\": 1, \"replicas\": 4, "
                 "\"sampler\": \"%s\"}",
                 samplers[k]);
        run_fit(*state, method, (const char *[]){"out", "--threads", "2"});
        read_table(&history, "out/history.tsv");
        const double energy = last(&history, "potential_energy", 0);
        const double error = last(&history, "potential_energy_error", 0);
        const double beside = results_number("out/summary.json", "potential_energy");
        const double noise = results_number("out/summary.json", "potential_energy_error");
        print_message("energy %g ± %g, of the verification %g ± %g\n", energy, error, beside,
                      noise);
        assert_true(error > 0 && error < 0.05 * fabs(energy));
        assert_true(fabs(energy - beside) < 5 * hypot(error, noise));
        const double acceptance = last(&history, "acceptance", 0);
        assert_true(acceptance > 0 && acceptance < 1);
        mf_data_table_clear(&history);
    }
}

/// Each iteration has a column; the last is what rdf_now.tsv has.
static void check_excess(const char *folder, size_t iterations) {
    char path[64];
    struct data_table now, excess;
    snprintf(path, sizeof path, "%s/rdf_now.tsv", folder);
    read_table(&now, path);
    snprintf(path, sizeof path, "%s/excess_history.tsv", folder);
    read_table(&excess, path);
    assert_int_equal(excess.columns, iterations + 1);
    assert_int_equal(excess.rows, now.rows);
    for (size_t k = 0; k < now.rows; k++) {
        assert_true(now.values[k * now.columns] == excess.values[k * excess.columns]);
        assert_true(now.values[k * now.columns + 4] ==
                    excess.values[k * excess.columns + iterations]);
    }
    mf_data_table_clear(&now);
    mf_data_table_clear(&excess);
}

static void test_excess_of_each_iteration_has_a_column(void **state) {
    run_fit(*state,
            "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"iterations\": 3, \"precision\": "
            "0.0001, \"samples\": 20}",
            (const char *[]){"out", "--threads", "1"});
    check_excess("out", 3);
}

/// Stopped after some iterations and gone on with, by other threads.
static void test_tables_are_the_same_bits_after_a_restart(void **state) {
    const char *method = "\"method\": {\"name\": \"imc\", \"replicas\": 4, "
                         "\"iterations\": 6, \"precision\": 0.005, \"samples\": 300}";
    run_fit(*state, method, (const char *[]){"whole", "--threads", "1"});
    run_program_in_pieces(result.code, (const char *const[]){"fit", "run.json", "-o", "parts",
                                                             "--threads", "2", NULL});
    results_assert_same("whole", "parts", tables);
}

/// A Gaussian core whose g(r) has few counts in its first bins: Φ is −ln g there, and known no
/// better, however smooth the prior.
static void test_phi_is_known_no_better_than_the_counts_of_its_target(void **state) {
    static const char fluid[] =
        "{\"seed\": 103, \"box\": [4, 4, 4], \"particles\": {\"count\": 64}, "
        "\"time_step\": 0.02, \"conservative\": {\"law\": \"gaussian\", \"epsilon\": 3, "
        "\"sigma\": 0.8, \"cutoff\": 1.6}, \"dissipative\": {\"law\": \"power\", "
        "\"sigma\": 3, \"cutoff\": 1}, \"rdf\": {\"range\": 1.6, \"bins\": 32}, "
        "\"measure\": {\"equilibration\": 300, \"samples\": 400, \"every\": 20}}";
    static const char fit[] =
        "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"out/rdf.tsv\", "
        "\"normalisation\": 1}, \"pressure\": {\"value\": 4.3, \"error\": 0.01}}, "
        "\"scene\": {\"box\": [4, 4, 4], \"particles\": {\"count\": 64}, \"time_step\": "
        "0.02, \"dissipative\": {\"law\": \"power\", \"sigma\": 3, \"cutoff\": 1}}, "
        "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"iterations\": 3}, "
        "\"verification\": {\"replicas\": 1, \"samples\": 10}}";
    struct data_table target = {0}, found = {0};
    int few = 0;
    temporary_folder_write(*state, "scene.json", fluid, strlen(fluid));
    temporary_folder_write(*state, "run.json", fit, strlen(fit));
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit");
    assert_true(result.code == 0 || result.code == 1);
    assert_ok(mf_data_table_read(&target, "out/rdf.tsv", 3));
    assert_ok(mf_data_table_read(&found, "fit/potential.tsv", 2));
    for (size_t k = 0; k < target.rows; k++) {
        const double *g = target.values + k * target.columns;
        const double *phi = found.values + k * found.columns;
        assert_true(fabs(g[0] - phi[0]) < 1e-6);
        if (!(phi[3] > 0))
            continue;
        if (!(phi[3] > 0.95 * g[2] / g[1] && phi[4] > 0.95 * g[2] / g[1]))
            fail_msg("r = %g: g %g(%g), errors of phi %g and %g", g[0], g[1], g[2], phi[3], phi[4]);
        few += g[2] > 0.1 * g[1];
    }
    assert_true(few >= 3);
    mf_data_table_clear(&target);
    mf_data_table_clear(&found);
}

/// Samples, equilibration and algebra are what the processor did up to the last iteration, but for
/// files; the verification, of 2000 samples and more, comes after it.
static void test_timing_says_what_the_time_went_to(void **state) {
    static const char *const parts[] = {"equilibration", "samples", "lost_samples", "algebra"};
    struct data_table timing;
    double sum = 0;
    run_fit(*state, "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"iterations\": 2}",
            (const char *[]){"out", "--threads", "1"});
    read_table(&timing, "out/timing.tsv");
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++) {
        assert_true(last(&timing, parts[k], 0) >= last(&timing, parts[k], 1));
        sum += last(&timing, parts[k], 0);
    }
    assert_true(last(&timing, "equilibration", 0) > 0 && last(&timing, "algebra", 0) > 0);
    assert_true(last(&timing, "samples", 0) + last(&timing, "lost_samples", 0) > 0);
    assert_true(sum <= last(&timing, "processor_seconds", 0) + 0.002);
    assert_true(last(&timing, "verification", 0) > 0 && last(&timing, "verification", 1) == 0);
    mf_data_table_clear(&timing);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            test_samples_of_the_last_iteration_have_the_rms_of_the_history,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_timing_says_what_the_time_went_to,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_energy_is_that_of_the_verification,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_excess_of_each_iteration_has_a_column,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_phi_is_known_no_better_than_the_counts_of_its_target,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_tables_are_the_same_bits_after_a_restart,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
