// SPDX-License-Identifier: GPL-3.0-or-later
//
// Texts of strangers' files, folders and command lines that would be commands of a terminal: a new
// title, a new clipboard (OSC 52), an empty screen, as ASCII, as UTF-8 and as ISO 8859. All that
// the program prints of them is shown, not obeyed.
#include "base/visible.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static struct run_program_result result;

#define IN_TABLE                                                                                   \
    "\x1b]0;title\x07\x1b]52;c;aGk=\x07\xc2\x9b"                                                   \
    "2J\x9b"                                                                                       \
    "2J"
#define COMMANDS IN_TABLE "\r" // which ends a line of a table
#define IN_JSON "\\u001b]0;title\\u0007\\u001b]52;c;aGk=\\u0007\\u009b2J\\r"

/// Returns how many commands are shown.
static int count_shown(const char *text, const char *what) {
    int shown = 0;
    for (size_t left = strlen(text), bytes; left > 0; text += bytes, left -= bytes) {
        bytes = mf_visible_character(text, left);
        const unsigned char first = (unsigned char)text[0];
        if (bytes == 0 || first == 0x7f || (first < 0x20 && !strchr("\n\t", first)) ||
            (first == 0xc2 && (unsigned char)text[1] < 0xa0))
            fail_msg("%s: the byte 0x%02x before \"%.60s\"", what, first, text + 1);
        shown += strncmp(text, "\\x1b", 4) == 0;
    }
    return shown;
}

/// Run, and return how many commands are shown.
static int run(const char *const *words) {
    run_program(&result, &(struct run_program_how){0}, words);
    return count_shown(result.out, words[0]) + count_shown(result.err, words[0]);
}

#define RUN(...) run((const char *const[]){__VA_ARGS__, NULL})

static void test_words_of_the_command_line_are_shown(void **state) {
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    assert_true(RUN(COMMANDS) > 0);
    assert_true(RUN("describe", COMMANDS) > 0);
    assert_true(RUN("simulate", COMMANDS ".json") > 0);
    assert_true(RUN("simulate", "scene.json", "-" COMMANDS) > 0);
    assert_true(RUN("simulate", "scene.json", "-o", "scene.json/" COMMANDS) > 0);
    assert_true(RUN("fit", "--target", COMMANDS) > 0);
    assert_true(RUN("measure", COMMANDS ".xyz") > 0);
    assert_true(RUN("plot", COMMANDS) > 0);
    assert_true(RUN("compare", COMMANDS) > 0);
    assert_true(RUN("export", COMMANDS, "--engine", "lammps") > 0);
    assert_true(RUN("live", COMMANDS) > 0);
    assert_true(RUN("simulate", "scene.json", "-o", COMMANDS) > 0);
    run_program_assert_code(&result, 0);
    RUN("compare", COMMANDS);
    run_program_assert_code(&result, 0);
    RUN("export", COMMANDS, "--engine", "lammps");
    run_program_assert_code(&result, 0);
}

static void test_texts_of_results_are_shown(void **state) {
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    char *summary = temporary_folder_read("out/summary.json");
    small_inputs_write(*state, "out/summary.json", summary, "\"ok\"", "\"" IN_JSON "\"");
    free(summary);
    char *table = temporary_folder_read("out/rdf.tsv");
    small_inputs_write(*state, "out/rdf.tsv", table, "[lambda]", "[" IN_TABLE "]");
    free(table);
    assert_true(RUN("compare", "out") > 0);
    assert_true(RUN("export", "out", "--engine", "lammps") > 0);
}

static void test_texts_of_scenes_and_run_files_are_shown(void **state) {
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    static const char *const names[] = {"\"seed\"", "\"count\"", "\"soft-repulsion\""};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        small_inputs_write(*state, "scene.json", small_inputs_scene, names[k], "\"" IN_JSON "\"");
        assert_true(RUN("simulate", "scene.json") > 0);
        assert_true(RUN("simulate", "scene.json", "--explain") > 0);
    }
    small_inputs_write(*state, "scene.json", small_inputs_scene, "\"seed\"",
                       "\"title\": \"" IN_JSON "\", \"seed\"");
    RUN("simulate", "scene.json");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "run.json", small_inputs_run, "target.tsv", IN_JSON);
    assert_true(RUN("fit", "run.json") > 0);
    small_inputs_write(*state, "run.json", small_inputs_run, "\"imc\"", "\"" IN_JSON "\"");
    assert_true(RUN("fit", "run.json", "--explain") > 0);
    small_inputs_write(*state, "target.tsv", small_inputs_target, "# r", "# r[" IN_TABLE "]");
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    RUN("fit", "run.json");
}

/// Atoms of a structure whose names are commands, and the masses that these make likely.
static void test_names_of_atoms_are_shown(void **state) {
    static const char structure[] = "\x1b]0;title\x07\n    2\n"
                                    "    1SOL  C\x1b[2J    1   0.100   0.100   0.100\n"
                                    "    2SOL  C\x1b[2J    2   0.600   0.500   0.400\n"
                                    "   1.00000   1.00000   1.00000\n";
    temporary_folder_write(*state, "odd.gro", structure, sizeof structure - 1);
    small_inputs_write(*state, "map.json", "{\"beads\": {\"W\": {\"residue\": \"SOL\"}}}", NULL,
                       NULL);
    assert_true(RUN("measure", "odd.gro", "--map", "map.json", "-o", "measured") > 0);
}

int main(void) {
#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)
    const struct CMUnitTest tests[] = {
        TEST(test_words_of_the_command_line_are_shown),
        TEST(test_texts_of_results_are_shown),
        TEST(test_texts_of_scenes_and_run_files_are_shown),
        TEST(test_names_of_atoms_are_shown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
