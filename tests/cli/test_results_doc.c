// SPDX-License-Identifier: GPL-3.0-or-later
//
// docs/results.md names every table that runs leave, every column and every key of
// summary.json.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <ctype.h>
#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static const char scene[] =
    "{\"seed\": 7, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, \"rdf\": {\"range\": 1, \"bins\": 20},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 80, \"every\": 5}, \"motion\": {\"lags\": "
    "10},\n"
    "\"dynamics\": {\"integrator\": \"dpd-verlet\"}, \"force_covariance\": {},\n"
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 6, \"times\": 6, \"every\": 2},\n"
    "\"structure_factor\": {\"q_maximum\": 9},\n"
    "\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": 9e-26}}\n";

#define FIT(target, unknowns, method)                                                              \
    "{\"target\": {\"rdf\": {\"file\": \"scene/rdf.tsv\"}" target                                  \
    "}, \"unknowns\": {\"potential\":"                                                             \
    " {\"maximum\": 30, \"coefficients\": 5, \"truth\": {\"law\": \"soft-repulsion\", \"a\": "     \
    "25}}" unknowns                                                                                \
    "}, \"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"    \
    "\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": 9e-26}},\n"                      \
    "\"method\": {" method "}, \"core\": {\"threshold\": 0.05, \"stiffness\": 50},\n"              \
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 10, \"every\": "      \
    "10}}\n"

static const struct {
    const char *file, *text;
} fits[] = {
    {"imc.json", FIT("", "", "\"name\": \"auto\", \"iterations\": 2")},
    {"joint.json",
     FIT(", \"msd\": {\"file\": \"scene/motion.tsv\"}, \"vacf\": {\"file\": \"scene/motion.tsv\","
         "\"value_column\": 4, \"error_column\": 5}, \"pressure\": {\"value\": 20, \"fitted\": "
         "\"no\"}, \"structure_factor\": {\"file\": \"scene/structure_factor.tsv\", \"q_maximum\": "
         "9}, \"etd\": {\"file\": \"scene/etd.tsv\", \"error_file\": \"scene/etd_error.tsv\","
         "\"r_minimum\": 0.4, \"r_maximum\": 0.9}",
         ", \"omega\": {\"curve\": \"power\", \"truth\": {\"law\": \"power\", \"sigma\": 3}}",
         "\"name\": \"pareto\", \"population\": 8, \"generations\": 2, \"equilibration\": 20, "
         "\"samples\": 12, \"every\": 5, \"temperature_tolerance\": 0.5")},
};

static char *doc;

static bool is_reported(const char *what) {
    char word[512];
    snprintf(word, sizeof word, "`%s`", what);
    return strstr(doc, word) != NULL;
}

static void assert_reported(const char *what, const char *file) {
    if (!is_reported(what))
        fail_msg("docs/results.md does not tell of `%s` in %s", what, file);
}

/// The page says once that numbers have an error, and a target's rmse a noise.
static void strip_error(char *key) {
    const size_t length = strlen(key);
    if (length > 6 && strcmp(key + length - 6, "_error") == 0)
        key[length - 6] = '\0';
    else if (length > 6 && strcmp(key + length - 6, "_noise") == 0)
        memcpy(key + length - 6, "_rmse", sizeof "_rmse");
}

/// Keys of an indented JSON text.
static void check_keys(const char *path) {
    char *text = temporary_folder_read(path);
    for (char *rest, *line = strtok_r(text, "\n", &rest); line;
         line = strtok_r(NULL, "\n", &rest)) {
        char *begin = strchr(line, '"'), *end = begin ? strchr(begin + 1, '"') : NULL;
        if (end == NULL || end[1] != ':')
            continue;
        *end = '\0';
        if (!is_reported(begin + 1))
            strip_error(begin + 1);
        assert_reported(begin + 1, path);
    }
    free(text);
}

/// Names of the columns, without their units; an iteration's or a member's number, and E(r0=…), are
/// no names.
static void check_columns(const char *path) {
    char *text = temporary_folder_read(path), *header = text;
    while (header && strchr(header, '\t') > strchr(header, '\n'))
        header = strchr(header, '\n') + 1; // a comment without columns
    assert_memory_equal(header, "# ", 2);
    header[strcspn(header, "\n")] = '\0';
    for (char *rest, *name = strtok_r(header + 2, "\t", &rest); name;
         name = strtok_r(NULL, "\t", &rest)) {
        name[strcspn(name, "[(")] = '\0';
        if (!isdigit(name[0]) && strncmp(name, "E", 1) != 0 && strstr(name, "_rmse") == NULL &&
            strstr(name, "_noise") == NULL && strncmp(name, "member", 6) != 0)
            assert_reported(name, path);
    }
    free(text);
}

static void check_folder(const char *folder) {
    struct dirent **entries;
    const int count = scandir(folder, &entries, NULL, alphasort);
    assert_true(count > 2);
    for (int k = 0; k < count; k++) {
        char path[512];
        const char *name = entries[k]->d_name;
        snprintf(path, sizeof path, "%s/%s", folder, name);
        if (name[0] != '.')
            assert_reported(name, folder);
        if (strstr(name, ".tsv"))
            check_columns(path);
        if (strcmp(name, "summary.json") == 0)
            check_keys(path);
        free(entries[k]);
    }
    free(entries);
}

static void test_doc_tells_of_all_that_runs_leave(void **state) {
    static struct run_program_result result;
    char path[1024];
    snprintf(path, sizeof path, "%s/docs/results.md", run_program_sources());
    doc = temporary_folder_read(path);
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "scene", "--quiet");
    run_program_assert_code(&result, 0);
    check_folder("scene");
    for (size_t k = 0; k < sizeof fits / sizeof *fits; k++) {
        small_inputs_write(*state, fits[k].file, fits[k].text, NULL, NULL);
        RUN_PROGRAM(&result, "fit", fits[k].file, "-o", "fit", "--force", "--quiet");
        if (result.code != 0)
            run_program_assert_code(&result, 1); // not converged
        check_folder("fit");
    }
    free(doc);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_doc_tells_of_all_that_runs_leave,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
