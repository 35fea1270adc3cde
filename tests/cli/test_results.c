// SPDX-License-Identifier: GPL-3.0-or-later
//
// `make results`: what READMEs of runs say is what the program finds, as far as a test can afford
// it; and the script changes nothing but its own blocks.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static char root[4096];

/// Value and error of a row "| `key` | 1.314(1) |"; NaN without it.
static double row_of(const char *text, const char *key, double *error) {
    char wanted[128], *end;
    snprintf(wanted, sizeof wanted, "\n| `%s` | ", key);
    const char *at = strstr(text, wanted);
    if (at == NULL)
        return NAN;
    at += strlen(wanted);
    const double value = strtod(at, &end);
    const char *point = memchr(at, '.', (size_t)(end - at));
    *error =
        *end == '(' ? strtod(end + 1, NULL) * (point ? pow(10, (double)(point + 1 - end)) : 1) : 0;
    return value;
}

static char *copy_and_run(struct temporary_folder *folder, const char *run) {
    char command[3 * 4096];
    (void)folder;
    snprintf(command, sizeof command,
             "cp -r '%s/runs/%s' run && '%s/tests/tools/results.sh' '%s' run", root, run, root,
             getenv("MESOFIT"));
    assert_int_equal(system(command), 0);
    return temporary_folder_read("run/README.md");
}

static char *stored(const char *run) {
    char path[2 * 4096];
    snprintf(path, sizeof path, "%s/runs/%s/README.md", root, run);
    return temporary_folder_read(path);
}

static void test_one_gas_is_what_its_page_says(void **state) {
    static const char *const keys[] = {"compressibility_factor", "compressibility_factor_walls",
                                       "collision_rate", "pressure"};
    char *fresh = copy_and_run(*state, "kinetic-gas"), *page = stored("kinetic-gas");
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        double now_error, then_error;
        const double now = row_of(fresh, keys[k], &now_error);
        const double then = row_of(page, keys[k], &then_error);
        assert_true(then_error > 0 && now_error > 0);
        assert_true(fabs(now - then) <= 4 * hypot(now_error, then_error));
    }
    // All before the block, and what follows it, stays.
    const size_t before = (size_t)(strstr(page, "<!-- results") - page);
    assert_memory_equal(fresh, page, before);
    assert_string_equal(strstr(fresh, "<!-- end -->"), strstr(page, "<!-- end -->"));
    free(fresh);
    free(page);
}

/// One in eight samples, so that a test can afford it; fits are as they are. Figures are not drawn.
static void shorten(const char *run) {
    char command[4096];
    snprintf(
        command, sizeof command,
        "cd '%s' && for file in *.json; do awk '/\"samples\":/ && !fit "
        "{ match($0, /\"samples\": *[0-9]+/); text = substr($0, RSTART, RLENGTH); n = text; "
        "gsub(/[^0-9]/, \"\", n); $0 = substr($0, 1, RSTART - 1) \"\\\"samples\\\": \" "
        "int(n / 8 < 40 ? 40 : n / 8) substr($0, RSTART + RLENGTH) } /\"target\":/ { fit = 1 } "
        "{ print }' \"$file\" >shorter && mv shorter \"$file\"; done",
        run);
    assert_int_equal(system(command), 0);
}

/// The next row "| `key` | text |" from here on; NULL if there is none.
static const char *next_row(const char *text, char key[64], char value[64]) {
    while (text && (text = strstr(text, "\n| `"))) {
        if (sscanf(text, "\n| `%63[^`]` | %63[^|\n] |", key, value) == 2)
            return text + 1;
        text++;
    }
    return NULL;
}

/// Rows that say an error agree within both; those that say a word are the same.
static void assert_rows_agree(const char *run, const char *fresh, const char *page) {
    char key[64], then_key[64], text[64], then_text[64];
    int compared = 0;
    while ((fresh = next_row(fresh, key, text))) {
        double error = 0, then_error = 0;
        page = next_row(page, then_key, then_text);
        assert_non_null(page);
        assert_string_equal(key, then_key);
        const double value = row_of(fresh - 1, key, &error);
        const double then = row_of(page - 1, key, &then_error);
        if (strspn(text, "-0123456789") == 0)
            assert_string_equal(text, then_text);
        else if (error > 0 && then_error > 0 && fabs(value - then) > 4 * hypot(error, then_error))
            fail_msg("runs/%s/README.md: %s is %s there, and %s now", run, key, then_text, text);
        compared++;
    }
    assert_null(next_row(page, then_key, then_text));
    assert_true(compared > 0);
}

static void test_pages_say_what_shorter_runs_find(void **state) {
    static const char *const runs[] = {"dpd-fluid",       "lennard-jones-dynamics",
                                       "monte-carlo",     "soft-discs",
                                       "active-brownian", "collision-dynamics"};
    small_inputs_write(*state, "program", "#!/bin/sh\nPATH=/none exec \"$REAL\" \"$@\"\n", NULL,
                       NULL);
    assert_int_equal(chmod("program", 0777), 0);
    assert_int_equal(setenv("REAL", getenv("MESOFIT"), 1), 0);
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++) {
        char command[3 * 4096], path[128];
        snprintf(path, sizeof path, "%s/README.md", runs[k]);
        snprintf(command, sizeof command, "cp -r '%s/runs/%s' .", root, runs[k]);
        assert_int_equal(system(command), 0);
        shorten(runs[k]);
        snprintf(command, sizeof command, "'%s/tests/tools/results.sh' ./program %s", root,
                 runs[k]);
        assert_int_equal(system(command), 0);
        char *fresh = temporary_folder_read(path), *page = stored(runs[k]);
        assert_rows_agree(runs[k], fresh, page);
        free(fresh);
        free(page);
    }
}

/// `units` of a summary has a pressure, too.
static void test_pressure_is_that_of_the_run_and_not_its_unit(void **state) {
    char command[2 * 4096];
    small_inputs_write(*state, "summary.json",
                       "{\n\t\"units\":\t{\n\t\t\"pressure\":\t446\n\t},\n\t\"pressure\":\t9992,\n"
                       "\t\"pressure_error\":\t17\n}\n",
                       NULL, NULL);
    snprintf(command, sizeof command,
             "awk -f '%s/tests/tools/results.awk' -v wanted=pressure summary.json >rows", root);
    assert_int_equal(system(command), 0);
    char *rows = temporary_folder_read("rows");
    assert_string_equal(rows, "| `pressure` | 9992(17) |\n");
    free(rows);
}

static void test_page_that_asks_for_nothing_is_refused(void **state) {
    char command[3 * 4096];
    (void)state;
    snprintf(
        command, sizeof command,
        "mkdir run && echo '# A page' >run/README.md && ! '%s/tests/tools/results.sh' '%s' run "
        "2>says",
        root, getenv("MESOFIT"));
    assert_int_equal(system(command), 0);
    char *says = temporary_folder_read("says");
    assert_contains(says, "asks for no results");
    free(says);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    if (getcwd(root, sizeof root) == NULL)
        return 1;
    const struct CMUnitTest tests[] = {
        TEST(test_one_gas_is_what_its_page_says),
        TEST(test_pages_say_what_shorter_runs_find),
        TEST(test_page_that_asks_for_nothing_is_refused),
        TEST(test_pressure_is_that_of_the_run_and_not_its_unit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
