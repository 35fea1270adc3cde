// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every file of runs/ is one that the program takes: rules that become stricter break none of them.
#include "shared/length.h"
#include "shared/run_program.h"
#include "shared/testing.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>

static bool has_target(const char *path) {
    char text[65536];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return strstr(text, "\"target\"") != NULL;
}

/// The methods of molecules simulate some seconds before they are told of, each as propane-imc.
static bool is_slow(const char *path) {
    return strncmp(path, "runs/propane-ibi/", 17) == 0 ||
           strncmp(path, "runs/propane-relative-entropy/", 30) == 0;
}

static void test_run_files_are_taken(void **state) {
    struct run_program_result result;
    glob_t found;
    (void)state;
    assert_int_equal(glob("runs/*/*.json", 0, NULL, &found), 0);
    assert_true(found.gl_pathc >= 50);
    for (size_t k = 0; k < found.gl_pathc; k++) {
        const char *path = found.gl_pathv[k];
        if (is_slow(path) && !length_is_long())
            continue;
        RUN_PROGRAM(&result, has_target(path) ? "fit" : "simulate", path, "--explain");
        if (result.code != 0)
            fail_msg("%s", result.err);
    }
    globfree(&found);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_run_files_are_taken)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
