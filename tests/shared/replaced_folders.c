// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/replaced_folders.h"

#include "shared/results.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

static struct run_program_result result;

#define SCENE(particles, more)                                                                     \
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": " particles ", \"time_step\": 0.02,\n"       \
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"                                \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, " more "\n"                              \
    "\"measure\": {\"equilibration\": 10, \"samples\": 20, \"every\": 1}}\n"
#define FIT(more)                                                                                  \
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target.tsv\"}" more "},\n"                   \
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"       \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}},\n"                                      \
    "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 5, \"samples\": 20, "     \
    "\"every\": 1, \"iterations\": 2}, \"verification\": {\"replicas\": 2, "                       \
    "\"equilibration\": 20, \"samples\": 10, \"every\": 5}}\n"

static const char two_beads[] = "two\n    2\n    1SOL     OW    1   0.100   0.100   0.100\n"
                                "    2SOL     OW    2   0.500   0.400   0.300\n   2.0 2.0 2.0\n";

const struct replaced_folder replaced_folders[] = {
    {{"simulate", "many.json"}, {"simulate", "few.json"}, {"rdf.tsv", "used.json"}, true},
    {{"fit", "much.json"}, {"fit", "little.json", "--force"}, {"rdf.tsv", "potential.tsv"}, true},
    {{"measure", "two.gro"}, {"measure", "two.gro", "--range", "0.7"}, {"rdf.tsv"}, false},
    {{"export", "mixed", "--engine", "hoomd"},
     {"export", "single", "--engine", "hoomd"},
     {"A-A.txt", "run.py"},
     false},
    {{"compare", "fitted"}, {"compare", "single"}, {"compare.tsv"}, false},
    {{NULL}, {NULL}, {NULL}, false},
};

void replaced_folders_write_inputs(struct temporary_folder *folder) {
    small_inputs_write(folder, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(folder, "two.gro", two_beads, NULL, NULL);
    small_inputs_write(
        folder, "many.json",
        SCENE("{\"count\": 81}",
              "\"motion\": {\"every\": 1, \"lags\": 8}, \"snapshots\": {\"every\": 5},"),
        NULL, NULL);
    small_inputs_write(folder, "few.json", SCENE("{\"count\": 81}", ""), NULL, NULL);
    small_inputs_write(folder, "mixed.json", SCENE("{\"types\": {\"A\": 40, \"B\": 41}}", ""), NULL,
                       NULL);
    small_inputs_write(folder, "much.json",
                       FIT(", \"pressure\": {\"value\": 30, \"error\": 1, \"fitted\": \"no\"}"),
                       NULL, NULL);
    small_inputs_write(folder, "little.json", FIT(""), NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "few.json", "-o", "single", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "mixed.json", "-o", "mixed", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "little.json", "-o", "fitted", "--quiet");
    assert_in_range(result.code, 0, 1);
}

int replaced_folders_run(const char *const *words, const char *out, const char *option) {
    const char *all[REPLACED_FOLDERS_WORDS + 5];
    int count = 0;
    for (; words[count]; count++)
        all[count] = words[count];
    const char *const more[] = {"-o", out, "--quiet", option, NULL};
    memcpy(all + count, more, sizeof more);
    run_program(&result, &(struct run_program_how){0}, all);
    return result.code;
}

/// The names of all files, but for the lists.
static char *list_files(const char *folder) {
    static char text[8192];
    char command[256];
    snprintf(command, sizeof command,
             "PATH=/bin:/usr/bin; cd %s && find . ! -name '.mesofit*' | sort", folder);
    FILE *stream = popen(command, "r");
    assert_non_null(stream);
    text[fread(text, 1, sizeof text - 1, stream)] = '\0';
    assert_int_equal(pclose(stream), 0);
    return strdup(text);
}

void replaced_folders_finish(const struct replaced_folder *one, const char *out) {
    if (one->resumes && replaced_folders_run(one->second, out, "--resume") != 2)
        return;
    if (replaced_folders_run(one->second, out, NULL) == 2)
        fail_msg("%s: %s", out, result.err);
}

static void write_mine(struct temporary_folder *folder, const char *out) {
    char path[64];
    snprintf(path, sizeof path, "%s/mine.tsv", out);
    temporary_folder_write(folder, path, "mine", 4);
}

void replaced_folders_assert_mine(const char *out) {
    char path[64];
    snprintf(path, sizeof path, "%s/mine.tsv", out);
    char *mine = temporary_folder_read(path);
    assert_string_equal(mine, "mine");
    free(mine);
}

void replaced_folders_assert_whole(const struct replaced_folder *one, const char *out) {
    char *files = list_files(out), *whole = list_files("whole");
    assert_string_equal(files, whole);
    free(files);
    free(whole);
    results_assert_same("whole", out, one->tables);
    replaced_folders_assert_mine(out);
}

void replaced_folders_remove(const char *folder) {
    char command[128];
    snprintf(command, sizeof command, "/bin/rm -rf %s", folder);
    assert_int_equal(system(command), 0);
}

void replaced_folders_begin(struct temporary_folder *folder, const struct replaced_folder *one,
                            const char *out) {
    replaced_folders_remove(out);
    if (replaced_folders_run(one->first, out, NULL) == 2)
        fail_msg("%s", result.err);
    write_mine(folder, out);
}

void replaced_folders_make_whole(struct temporary_folder *folder,
                                 const struct replaced_folder *one) {
    replaced_folders_remove("whole");
    if (replaced_folders_run(one->second, "whole", NULL) == 2)
        fail_msg("%s", result.err);
    write_mine(folder, "whole");
}

const char *replaced_folders_message(void) {
    return result.err;
}
