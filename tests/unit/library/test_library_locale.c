// SPDX-License-Identifier: GPL-3.0-or-later
//
// A process whose decimals have a comma, as applications of GTK, Qt and R make it: the library
// reads and writes numbers with a point in each of its threads, and leaves the process its commas.
#include "mesofit.h"

#include "base/parallel.h"
#include "optimise/coroutine.h"
#include "shared/german.h"
#include "shared/testing.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const char scene[] =
    "{\"box\": [4, 4, 4], \"particles\": {\"count\": 190}, \"time_step\": 0.02, \"conservative\": "
    "{\"law\": \"table\", \"file\": \"phi\"}, \"dissipative\": {\"law\": \"power\", \"sigma\": 3}, "
    "\"measure\": {\"equilibration\": 20, \"samples\": 4, \"every\": 5}, \"rdf\": {\"range\": 1.5, "
    "\"bins\": 10}}";

static const double points[] = {0, 12.5, 0.25, 7.03125, 0.5, 3.125, 0.75, 0.78125, 1, 0};

static bool made; // or there is nothing to make it of

static int make(void **state) {
    temporary_folder_create(state);
    made = german_make(*state);
    return 0;
}

static int enter(void **state) {
    (void)state;
    return !made || setlocale(LC_ALL, "de_DE.UTF-8") ? 0 : -1;
}

static int leave(void **state) {
    (void)state;
    return setlocale(LC_ALL, "C") ? 0 : -1;
}

static int end(void **state) {
    unsetenv("LOCPATH");
    return temporary_folder_remove(state);
}

static void assert_still_german(void) {
    char text[8];
    snprintf(text, sizeof text, "%.1f", 0.5);
    assert_string_equal(text, "0,5");
}

static void simulate(const char *out) {
    static const struct mesofit_text text = {"scene", scene};
    static const struct mesofit_table table = {"phi", 5, 2, points};
    static const struct mesofit_inputs inputs = {
        .texts = &text, .text_count = 1, .tables = &table, .table_count = 1};
    const char *const words[] = {"simulate", "scene", "-o", out};
    struct mesofit_run *const run = mesofit_run_create();
    if (mesofit_run_words(run, 4, words, &inputs) != MESOFIT_OK)
        fail_msg("%s", mesofit_message());
    mesofit_run_free(run);
}

static void test_files_have_points_when_the_process_has_commas(void **state) {
    struct temporary_folder *const folder = *state;
    static const char *const files[] = {"rdf.tsv", "thermodynamics.tsv", "used.json"};
    char german[1024], plain[1024], command[2200];
    if (!made)
        skip();
    snprintf(german, sizeof german, "%s", temporary_folder_file(folder, "german"));
    snprintf(plain, sizeof plain, "%s", temporary_folder_file(folder, "plain"));
    simulate(german);
    assert_still_german();
    struct mesofit_result *const result = mesofit_result_open(german);
    struct mesofit_columns rdf;
    assert_ok((enum status)mesofit_result_table(result, "rdf", &rdf));
    assert_true(fabs(rdf.values[0] - 0.075) < 1e-12);
    mesofit_result_free(result);
    assert_still_german();
    setlocale(LC_ALL, "C");
    simulate(plain);
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        snprintf(command, sizeof command, "cmp '%s/%s' '%s/%s'", german, files[k], plain, files[k]);
        assert_int_equal(system(command), 0);
    }
}

static void test_simulation_that_is_stepped_reads_and_tells_points(void **state) {
    (void)state;
    if (!made)
        skip();
    struct mesofit_scene own = mesofit_scene_default();
    own.box[0] = own.box[1] = own.box[2] = 4.5;
    own.particles = 190;
    own.conservative.text = "{\"law\": \"soft-repulsion\", \"a\": 24.5}";
    struct mesofit_simulation *const simulation = mesofit_simulation_create(&own);
    assert_non_null(simulation);
    assert_contains(mesofit_simulation_text(simulation), "24.5");
    mesofit_simulation_free(simulation);
    assert_still_german();
}

static enum status say_number(void *context, size_t task, void *result) {
    (void)context, (void)task;
    snprintf(result, 8, "%.1f", 0.5);
    nanosleep(&(const struct timespec){.tv_nsec = 20000000}, NULL); // so that both threads have one
    return STATUS_OK;
}

static void take_number(void *context, size_t task, const void *result) {
    char(*const said)[8] = context;
    snprintf(said[task], 8, "%s", (const char *)result);
}

static void say_one(struct coroutine *self, void *context) {
    (void)self;
    snprintf(context, 8, "%.1f", 0.5);
}

static void test_threads_have_the_locale_of_who_began_them(void **state) {
    (void)state;
    if (!made)
        skip();
    const locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0), before = uselocale(plain);
    char said[5][8] = {""};
    const struct parallel_tasks tasks = {.count = 4,
                                         .threads = 2,
                                         .run = say_number,
                                         .take = take_number,
                                         .context = said,
                                         .result_size = 8};
    assert_ok(mf_parallel_try(&tasks));
    struct coroutine *const coroutine = mf_coroutine_begin(say_one, said[4]);
    assert_null(mf_coroutine_question(coroutine));
    mf_coroutine_end(coroutine);
    uselocale(before);
    for (int k = 0; k < 5; k++)
        assert_string_equal(said[k], "0.5");
    assert_still_german();
    freelocale(plain);
}

int main(void) {
    const struct CMUnitTest tests[] = {
#define IN_GERMAN(function) cmocka_unit_test_setup_teardown(function, enter, leave)
        IN_GERMAN(test_files_have_points_when_the_process_has_commas),
        IN_GERMAN(test_simulation_that_is_stepped_reads_and_tells_points),
        IN_GERMAN(test_threads_have_the_locale_of_who_began_them),
    };
    return cmocka_run_group_tests(tests, make, end);
}
