// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every file of runs/ is one that the program takes: rules that become stricter break none of them.
#include "shared/length.h"
#include "shared/run_program.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool has(const char *path, const char *key) {
    char text[65536];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return strstr(text, key) != NULL;
}

/// Seconds before they are notified of: methods of molecules simulate, each as propane-imc, and
/// tables of many bins are looked at for their normalisation.
static bool is_slow(const char *path) {
    static const char *const slow[] = {"runs/propane-ibi/",
                                       "runs/propane-relative-entropy/",
                                       "runs/standard-set/argon/run",
                                       "runs/standard-set/hexane/",
                                       "runs/standard-set/mixture-dilute/run",
                                       "runs/standard-set/mixture-votca/",
                                       "runs/standard-set/propane/",
                                       "runs/standard-set/urea-water/",
                                       NULL};
    for (const char *const *name = slow; *name; name++)
        if (strncmp(path, *name, strlen(*name)) == 0)
            return true;
    return false;
}

/// Maps, molecules and initial files are no scenes, and neither is what a run wrote.
static bool is_run(const char *path) {
    return strstr(path, "/out/") == NULL && !has(path, "\"system\"") &&
           (has(path, "\"target\"") || has(path, "\"box\"") || has(path, "\"density\""));
}

static void take(const char *path) {
    struct run_program_result result;
    RUN_PROGRAM(&result, has(path, "\"target\"") ? "fit" : "simulate", path, "--explain");
    if (result.code != 0)
        fail_msg("%s", result.err);
}

static void test_run_files_are_taken(void **state) {
    glob_t found;
    size_t runs = 0;
    (void)state;
    assert_int_equal(glob("runs/*/*.json", 0, NULL, &found), 0);
    assert_int_equal(glob("runs/*/*/*.json", GLOB_APPEND, NULL, &found), 0);
    for (size_t k = 0; k < found.gl_pathc; k++) {
        const char *path = found.gl_pathv[k];
        if (!is_run(path))
            continue;
        runs++;
        if (!is_slow(path) || length_is_long())
            take(path);
    }
    assert_true(runs >= 100);
    globfree(&found);
}

/// Tables may be pipes, which are gone once they were read: constraints, friction and defaults are
/// chosen from what was read of them.
static void test_run_files_are_opened_once(void **state) {
    struct temporary_folder *folder = *state;
    static struct run_program_result result;
    char command[4096];
    const int length =
        snprintf(command, sizeof command,
                 "in=$PWD/runs/standard-set/chains-of-six && cd '%s' && "
                 "sed 's/[.]tsv/.pipe/' $in/run.json >run.json && "
                 "for name in rdf bond_lengths bond_angles; do "
                 "mkfifo $name.pipe && { timeout 300 cat $in/$name.tsv >$name.pipe & } done",
                 folder->path);
    assert_in_range(length, 1, sizeof command - 1);
    assert_int_equal(system(command), 0);
    RUN_PROGRAM(&result, "fit", temporary_folder_file(folder, "run.json"), "--friction",
                "exportable", "--explain");
    run_program_assert_code(&result, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_run_files_are_taken),
        cmocka_unit_test_setup_teardown(test_run_files_are_opened_once, temporary_folder_create,
                                        temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
