// SPDX-License-Identifier: GPL-3.0-or-later
//
// --live and live from the command line; tests/live has what a page does with them.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
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
        {{"simulate", "scene.json", "--live=-1"}, "1 to 65535"},
        {{"simulate", "scene.json", "--lives"}, "--live"},
    };
    struct temporary_folder *folder = *state;
    if (!has_live())
        skip();
    small_inputs_write(folder, "scene.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(folder, "broken.json", "{", NULL, NULL);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        run_program(&result, &(struct run_program_how){0}, cases[k].words);
        run_program_assert_refused(&result, ".", cases[k].part, 1,
                                   (const char *const[]){cases[k].part, NULL});
    }
}

static void test_page_without_a_run_ends_well_with_ctrl_c(void **state) {
    const struct run_program_how how = {.interrupt_with = SIGINT};
    (void)state;
    if (!has_live())
        skip();
    run_program(&result, &how, (const char *const[]){"live", NULL});
    run_program_assert_code(&result, 0);
}

/// It would serve for ever, and nobody knew where.
static void test_page_whose_address_cannot_be_told_is_not_served(void **state) {
    static const char *const words[] = {"live", "live scene.json --stay",
                                        "simulate scene.json -o out --live"};
    if (!has_live())
        skip();
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        char line[256];
        snprintf(line, sizeof line, "timeout 60 \"$MESOFIT\" %s >/dev/full 2>err.txt; test $? = 2",
                 words[k]);
        assert_int_equal(system(line), 0);
        char *said = temporary_folder_read("err.txt");
        assert_string_equal(said, "mesofit: cannot write the address of the live view to stdout: "
                                  "No space left on device\n");
        free(said);
        assert_false(temporary_folder_exists("out"));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            test_simulation_with_a_page_that_nobody_opens_has_the_same_tables,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_what_cannot_be_shown_is_refused_in_one_line,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_page_whose_address_cannot_be_told_is_not_served,
                                        small_inputs_enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_page_without_a_run_ends_well_with_ctrl_c,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
