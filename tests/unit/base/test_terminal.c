// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is printed into a stream of base/terminal, read at the other end of a pipe.
#include "base/terminal.h"
#include "shared/testing.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int ends[2];
static struct terminal terminal;
static FILE *stream;

static int enter(void **state) {
    (void)state;
    return pipe(ends) == 0 && (stream = mf_terminal_open(&terminal, ends[1])) ? 0 : -1;
}

static int leave(void **state) {
    (void)state;
    fclose(stream);
    close(ends[0]);
    return close(ends[1]);
}

/// What has come out since the last time.
static const char *shown(void) {
    static char text[65536];
    fflush(stream);
    assert_int_equal(write(ends[1], "\n", 1), 1);
    const ssize_t size = read(ends[0], text, sizeof text - 1);
    assert_true(size > 0);
    text[size - 1] = '\0';
    return text;
}

static void test_terminal_gets_no_commands_but_lines_and_tabs(void **state) {
    (void)state;
    fprintf(stream, "a\tb\n%s", "\x1b]52;c;aGk=\a\r\x1b[2J\xc2\x9b\x9b\x7f");
    fputc('\0', stream);
    assert_string_equal(shown(),
                        "a\tb\n\\x1b]52;c;aGk=\\x07\\x0d\\x1b[2J\\xc2\\x9b\\x9b\\x7f\\x00");
}

/// Wherever a stream cuts a text in two.
static void test_characters_that_come_in_pieces_are_whole(void **state) {
    static const char text[] = "1 \xc3\xa9 \xe2\x88\x92 \xf0\x9f\x98\x80 \xc2\x9b \xe2\x88!";
    (void)state;
    for (size_t cut = 0; cut < sizeof text; cut++) {
        fwrite(text, 1, cut, stream);
        fflush(stream);
        fwrite(text + cut, 1, sizeof text - 1 - cut, stream);
        assert_string_equal(shown(),
                            "1 \xc3\xa9 \xe2\x88\x92 \xf0\x9f\x98\x80 \\xc2\\x9b \\xe2\\x88!");
    }
}

static void test_long_texts_arrive_whole(void **state) {
    char text[9001], expected[4 * 9000 + 1];
    (void)state;
    for (int k = 0; k < 9000; k++) {
        text[k] = '\x1b';
        memcpy(expected + 4 * k, "\\x1b", 4);
    }
    text[9000] = expected[4 * 9000] = '\0';
    fputs(text, stream);
    assert_string_equal(shown(), expected);
}

static void test_full_disk_is_an_error(void **state) {
    FILE *full = fopen("/dev/full", "w");
    (void)state;
    assert_non_null(full);
    static struct terminal broken;
    FILE *out = mf_terminal_open(&broken, fileno(full));
    fputs("x", out);
    assert_int_equal(fflush(out), EOF);
    assert_true(ferror(out));
    fclose(out);
    fclose(full);
}

int main(void) {
#define WITH_PIPE(test) cmocka_unit_test_setup_teardown(test, enter, leave)
    const struct CMUnitTest tests[] = {
        WITH_PIPE(test_terminal_gets_no_commands_but_lines_and_tabs),
        WITH_PIPE(test_characters_that_come_in_pieces_are_whole),
        WITH_PIPE(test_long_texts_arrive_whole),
        WITH_PIPE(test_full_disk_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
