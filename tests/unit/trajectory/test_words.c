// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/testing.h"
#include "trajectory/words.h"

#include <stdio.h>
#include <stdlib.h>

static bool number(const char *text, double *value) {
    return mf_words_number(&(struct word){text, strlen(text)}, value);
}

/// The bits of strtod, for numbers of any length.
static void test_numbers_are_those_of_strtod(void **state) {
    static const char *const formats[] = {"%.3f", "%.8f", "%g", "%.17g", "%.12e", "%.0f", "%+.5f"};
    uint64_t random = 1;
    (void)state;
    for (int k = 0; k < 70000; k++) {
        char text[64];
        double value;
        random = random * 6364136223846793005u + 1442695040888963407u;
        const double size = (double)((int64_t)random >> 20) / (1 << (k % 30));
        snprintf(text, sizeof text, formats[k % 7], size);
        assert_true(number(text, &value));
        assert_true(value == strtod(text, NULL));
    }
}

static void test_numbers_are_refused_when_they_are_none(void **state) {
    static const char *const bad[] = {"",    "-",   ".",   "1.2.3", "1e",    "nan",  "inf", "0x10",
                                      "1,5", "--1", "+-1", "1 2",   "1e999", "five", "1-"};
    static const char *const good[] = {"1.", ".5", "-0", "+3", "1e3", "1E-3", "000012"};
    double value;
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_false(number(bad[k], &value));
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        assert_true(number(good[k], &value));
        assert_true(value == strtod(good[k], NULL));
    }
}

static void test_integers_have_at_most_18_digits(void **state) {
    int64_t value;
    (void)state;
    assert_true(mf_words_integer(&(struct word){"-999999999999999999", 19}, &value));
    assert_true(value == -999999999999999999);
    assert_false(mf_words_integer(&(struct word){"9999999999999999999", 19}, &value));
    assert_false(mf_words_integer(&(struct word){"1.0", 3}, &value));
    assert_false(mf_words_integer(&(struct word){"-", 1}, &value));
}

static void test_columns_and_lines_end_where_the_text_does(void **state) {
    char line[8];
    const unsigned char *text = (const unsigned char *)"one\r\ntwo and more\nthree";
    struct word word = mf_words_columns("  ab  cd", 1, 4);
    (void)state;
    assert_true(mf_words_same(&word, "ab"));
    word = mf_words_columns("abc", 5, 10);
    assert_int_equal(word.length, 0);
    assert_true(mf_words_line(text, 23, 0, line, sizeof line));
    assert_string_equal(line, "one");
    assert_true(mf_words_line(text, 23, 1, line, sizeof line));
    assert_string_equal(line, "two and");
    assert_true(mf_words_line(text, 23, 2, line, sizeof line));
    assert_string_equal(line, "three");
    assert_false(mf_words_line(text, 23, 3, line, sizeof line));
    assert_int_equal(mf_words_count(" a\tb  c "), 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_are_those_of_strtod),
        cmocka_unit_test(test_numbers_are_refused_when_they_are_none),
        cmocka_unit_test(test_integers_have_at_most_18_digits),
        cmocka_unit_test(test_columns_and_lines_end_where_the_text_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
