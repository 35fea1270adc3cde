// SPDX-License-Identifier: GPL-3.0-or-later
//
// The whole reference: docs/reference.md is what the program prints, and the man page is good roff;
// both tell of every subcommand, option, object and key.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

enum { COMMAND_SIZE = 4096 };

static struct run_program_result result;

/// What a command of the shell prints, in which "$MESOFIT" is the program; free() it.
static char *shell(const char *command) {
    char line[COMMAND_SIZE];
    snprintf(line, sizeof line, "(%s) >shell.txt 2>&1", command);
    if (system(line) != 0)
        fail_msg("failed: %s\n%s", command, temporary_folder_read("shell.txt"));
    return temporary_folder_read("shell.txt");
}

static void test_reference_page_is_what_the_program_prints(void **state) {
    (void)state;
    char path[1024];
    snprintf(path, sizeof path, "%s/docs/reference.md", run_program_sources());
    char *page = temporary_folder_read(path);
    char *printed = shell("\"$MESOFIT\" describe --format markdown");
    if (strcmp(page, printed) != 0)
        fail_msg("docs/reference.md is not what the program prints: `make docs` makes it anew");
    free(page);
    free(printed);
}

/// Markdown and the man page have `name` as they set off names.
static void assert_reported(const char *markdown, const char *man, const char *name) {
    char quoted[256], bold[256];
    size_t used = (size_t)snprintf(bold, sizeof bold, "\\fB");
    for (const char *letter = name; *letter; letter++)
        used += (size_t)snprintf(bold + used, sizeof bold - used, "%s%c",
                                 *letter == '-' ? "\\" : "", *letter);
    snprintf(quoted, sizeof quoted, "\n`%s", name);
    if (strstr(markdown, quoted) == NULL || strstr(man, bold) == NULL)
        fail_msg("the reference does not tell of %s", name);
}

/// Every word that --help and `describe` begin a line with, two blanks from the edge.
static void test_reference_tells_of_every_option_object_and_key(void **state) {
    (void)state;
    char *markdown = shell("\"$MESOFIT\" describe --format markdown");
    char *man = shell("\"$MESOFIT\" describe --format man");
    char *options = shell("\"$MESOFIT\" --help | sed -n 's/^  \\(-[^ ]*\\).*/\\1/p'");
    char *keys = shell("for group in $(\"$MESOFIT\" describe | grep '^[a-z]'); do "
                       "\"$MESOFIT\" describe $group | sed -n 's/^  \\([^ ]*\\) .*/\\1/p'; "
                       "done | sort -u");
    size_t count = 0;
    for (char *rest, *name = strtok_r(options, "\n", &rest); name;
         name = strtok_r(NULL, "\n", &rest), count++)
        assert_reported(markdown, man, name);
    for (char *rest, *name = strtok_r(keys, "\n", &rest); name;
         name = strtok_r(NULL, "\n", &rest), count++)
        assert_reported(markdown, man, name);
    assert_true(count > 100);
    free(markdown);
    free(man);
    free(options);
    free(keys);
}

static void test_reference_links_lead_to_sections(void **state) {
    (void)state;
    char *markdown = shell("\"$MESOFIT\" describe --format markdown");
    size_t count = 0;
    for (char *at = markdown; (at = strstr(at, "](#")); at++, count++) {
        char section[128], chapter[128];
        const int length = (int)strcspn(at + 3, ")");
        snprintf(section, sizeof section, "\n### %.*s\n", length, at + 3);
        snprintf(chapter, sizeof chapter, "\n## Keys: %.*s\n", length - 5, at + 8);
        if (strstr(markdown, section) == NULL && strstr(markdown, chapter) == NULL)
            fail_msg("no section of %.*s", length, at + 3);
    }
    assert_true(count > 10);
    free(markdown);
}

/// What all inversions have in common: once in the document, with each of them on the terminal.
static void test_reference_prints_a_shared_table_once(void **state) {
    (void)state;
    static const char *const methods[] = {"imc", "ibi", "inversions"};
    char *markdown = shell("\"$MESOFIT\" describe --format markdown");
    const char *row = strstr(markdown, "\n`sampler` |");
    assert_non_null(row);
    assert_null(strstr(row + 1, "\n`sampler` |"));
    assert_contains(strstr(markdown, "\n### imc\n"), "[inversions](#inversions)");
    free(markdown);
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        RUN_PROGRAM(&result, "describe", methods[k]);
        assert_contains(result.out, "\n  sampler ");
    }
}

/// Its parts by their names, and groff without a word of complaint.
static void test_man_page_is_good_roff(void **state) {
    (void)state;
    static const char *const parts[] = {".TH MESOFIT 1 ",   "\n.SH \"NAME\"\nmesofit \\- ",
                                        ".SH \"SYNOPSIS\"", ".SH \"COMMANDS\"",
                                        ".SH \"OPTIONS\"",  ".SH \"EXIT STATUS\""};
    char *man = shell("\"$MESOFIT\" describe --format man");
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        assert_contains(man, parts[k]);
    free(man);
    if (system("command -v groff >/dev/null") == 0) {
        char *faults = shell("\"$MESOFIT\" describe --format man | groff -man -ww -z -K utf8");
        assert_string_equal(faults, "");
        free(faults);
    }
}

static void test_formats_that_are_not_known_are_refused(void **state) {
    (void)state;
    RUN_PROGRAM(&result, "describe", "--format", "markdwn");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "did you mean \"markdown\"?");
    RUN_PROGRAM(&result, "describe", "--format", "man", "imc");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "NAME");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_reference_page_is_what_the_program_prints),
        TEST(test_reference_tells_of_every_option_object_and_key),
        TEST(test_reference_links_lead_to_sections),
        TEST(test_reference_prints_a_shared_table_once),
        TEST(test_man_page_is_good_roff),
        TEST(test_formats_that_are_not_known_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
