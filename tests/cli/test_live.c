// SPDX-License-Identifier: GPL-3.0-or-later
//
// --live, live and watch from the command line; tests/live has what a page does with them.
#include "io/data_table.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static struct run_program_result result;

static bool has_live(void) {
    RUN_PROGRAM(&result, "live", "missing.json");
    return strstr(result.err, "was built without the live view") == NULL;
}

static void test_simulation_with_a_page_that_nobody_opens_has_the_same_tables(void **state) {
    static const char *const tables[] = {"rdf.tsv", "thermodynamics.tsv", "used.json"};
    struct temporary_folder *folder = *state;
    if (!has_live())
        skip();
    small_inputs_write(folder, "scene.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "plain", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "live", "--quiet", "--live");
    run_program_assert_code(&result, 0);
    assert_int_equal(run_program_lines(result.out), 1);
    assert_int_equal(strncmp(result.out, "live at http://127.0.0.1:", 25), 0);
    assert_int_equal(strlen(strstr(result.out, "/?token=")), strlen("/?token=\n") + 32);
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
        char one[64], other[64];
        snprintf(one, sizeof one, "plain/%s", tables[k]);
        snprintf(other, sizeof other, "live/%s", tables[k]);
        char *plain = temporary_folder_read(one), *live = temporary_folder_read(other);
        assert_string_equal(plain, live);
        free(plain);
        free(live);
    }
}

/// The rms of g − g* stands in the history, too, where the method has summed it by itself.
static void test_samples_of_the_last_iteration_have_the_rms_of_the_history(void **state) {
    struct temporary_folder *folder = *state;
    struct data_table now, history;
    small_inputs_write(folder, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(folder, "target.tsv", small_inputs_target, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    assert_ok(mf_data_table_read(&now, "out/rdf_now.tsv", 5));
    assert_ok(mf_data_table_read(&history, "out/history.tsv", 5));
    double sum = 0, errors = 0;
    for (size_t k = 0; k < now.rows; k++) {
        const double *row = now.values + k * now.columns;
        sum += pow(row[2] - row[1], 2);
        errors += row[3] * row[3];
        assert_true(row[4] * (row[2] - row[1]) >= 0);
    }
    const size_t column = mf_data_table_find(&history, "rdf_rms") - 1;
    const double rms = history.values[(history.rows - 1) * history.columns + column];
    assert_true(rms > 0);
    assert_true(fabs(sqrt(sum / (double)now.rows) - rms) < 1e-6 * rms);
    assert_true(errors > 0 && sqrt(errors / (double)now.rows) < 1);
    mf_data_table_clear(&now);
    mf_data_table_clear(&history);
}

static void test_what_cannot_be_shown_is_refused_in_one_line(void **state) {
    static const struct {
        const char *words[5], *part;
    } cases[] = {
        {{"live", "missing.json"}, "missing.json"},
        {{"live", "broken.json"}, "broken.json:1:"},
        {{"live", "scene.json", "--port", "0"}, "1 to 65535"},
        {{"live", "scene.json", "--port", "many"}, "1 to 65535"},
        {{"live", "--start"}, "--start takes a scene"},
        {{"live", ".", "--start"}, "nothing to start"},
        {{"simulate", "scene.json", "--live=70000"}, "1 to 65535"},
        {{"simulate", "scene.json", "--live=x"}, "1 to 65535"},
        {{"simulate", "scene.json", "--lives"}, "--live"},
        {{"watch", "missing"}, "missing"},
        {{"watch", "scene.json"}, "not a folder"},
        {{"watch", "."}, "needs a terminal"},
    };
    struct temporary_folder *folder = *state;
    if (!has_live())
        skip();
    small_inputs_write(folder, "scene.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(folder, "broken.json", "{", NULL, NULL);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        run_program(&result, &(struct run_program_how){.time_limit = 20}, cases[k].words);
        run_program_assert_refused(&result, ".", cases[k].part, 1,
                                   (const char *const[]){cases[k].part, NULL});
    }
}

static void test_page_without_a_run_ends_well_with_ctrl_c(void **state) {
    const struct run_program_how how = {
        .interrupt_after = 0.5, .interrupt_from_start = true, .time_limit = 20};
    (void)state;
    if (!has_live())
        skip();
    run_program(&result, &how, (const char *const[]){"live", NULL});
    run_program_assert_code(&result, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            test_samples_of_the_last_iteration_have_the_rms_of_the_history,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(
            test_simulation_with_a_page_that_nobody_opens_has_the_same_tables,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_what_cannot_be_shown_is_refused_in_one_line,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_page_without_a_run_ends_well_with_ctrl_c,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
