// SPDX-License-Identifier: GPL-3.0-or-later
//
// Completions of bash, as bash asks for them: COMP_WORDS is what stands in the line.
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/// What the words, of which the last may be incomplete, may go on with, blanks between, in the
/// order of the alphabet; free() it.
static char *complete(const char *words) {
    char line[2048];
    snprintf(line, sizeof line,
             "\"$MESOFIT\" describe --format bash >mesofit.bash && bash -uc '"
             ". ./mesofit.bash; COMP_WORDS=(mesofit %s); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); "
             "_mesofit; printf \"%%s\\n\" \"${COMPREPLY[@]}\" | LC_ALL=C sort | tr \"\\n\" \" \"' "
             ">completions.txt 2>&1",
             words);
    assert_int_equal(system(line), 0);
    return temporary_folder_read("completions.txt");
}

static void assert_completes(const char *words, const char *expected) {
    char *completions = complete(words);
    assert_string_equal(completions, expected);
    free(completions);
}

static void assert_has(const char *words, const char *expected) {
    char *completions = complete(words), wanted[64];
    snprintf(wanted, sizeof wanted, "%s ", expected);
    assert_contains(completions, wanted);
    free(completions);
}

static void test_completion_knows_subcommands_and_options(void **state) {
    (void)state;
    assert_completes("\"\"",
                     "bench compare describe export film fit import live measure plot simulate ");
    assert_completes("co", "compare ");
    assert_completes("fit --e", "--engine --explain ");
    assert_completes("fit --re", "--resume ");
    assert_completes("fit --l", "--live ");
    assert_completes("bench \"\"", "accuracy engine samplers stability ");
    assert_completes("describe --format \"\"", "bash man markdown schema ");
    assert_completes("fit --seed \"\"", " ");
}

static void test_completion_knows_what_describe_knows(void **state) {
    (void)state;
    assert_completes("describe gau", "gauss-newton gaussian ");
    assert_completes("describe targ", "target "); // a topic and its group
    assert_completes("describe unk", "unknowns ");
    assert_completes("describe tab", "table "); // of several groups
    assert_has("describe \"\"", "cma-es");
    assert_has("describe \"\"", "shardlow");
    assert_has("describe \"\"", "rdf-target");
    assert_has("describe \"\"", "method");
}

static void test_completion_knows_files_and_folders_of_runs(void **state) {
    assert_int_equal(mkdir("runs", 0777), 0);
    assert_int_equal(mkdir("runs/water", 0777), 0);
    assert_int_equal(mkdir("runs/water/an out", 0777), 0);
    assert_int_equal(mkdir("runs/water/figures", 0777), 0);
    small_inputs_write(*state, "runs/water/run.json", "{}", NULL, NULL);
    small_inputs_write(*state, "runs/water/an out/summary.json", "{}", NULL, NULL);
    assert_completes("plot ru", "runs ");
    assert_completes("plot runs/", "runs/water ");
    assert_completes("compare runs/water/a runs/water/", "runs/water/an out ");
    assert_completes("fit runs/water/r", "runs/water/run.json ");
    assert_completes("simulate run.json -o runs/water/", "runs/water/an out runs/water/figures ");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_completion_knows_subcommands_and_options),
        TEST(test_completion_knows_what_describe_knows),
        TEST(test_completion_knows_files_and_folders_of_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
