// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/visible.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>

static void test_visible_copy_shows_control_characters(void **state) {
    static const struct {
        const char *text, *kept, *expected;
    } cases[] = {
        {"plain", "", "plain"},
        {"", "", ""},
        {"\x1b[31mred\a\x7f", "", "\\x1b[31mred\\x07\\x7f"},
        {"a\nb\tc", "\n", "a\nb\\x09c"},
        {"a\nb", "", "a\\x0ab"},
        {"r\xc3\xa9\xcf\x80 \xe2\x88\x92", "", "r\xc3\xa9\xcf\x80 \xe2\x88\x92"}, // é π −
        {"\xc2\x9b"
         "2J\xc2\xb5",
         "", "\\xc2\\x9b2J\xc2\xb5"}, // CSI as one character; µ
        {"\xf0\x9f\x98\x80", "", "\xf0\x9f\x98\x80"},
        // No UTF-8: CSI of a terminal of ISO 8859, longer spellings, a surrogate, too large, cut
        // off.
        {"\x9b"
         "2J",
         "", "\\x9b2J"},
        {"caf\xe9!", "", "caf\\xe9!"},
        {"\xff\xc2", "", "\\xff\\xc2"},
        {"\xc0\x9b", "", "\\xc0\\x9b"},
        {"\xe0\x80\x9b", "", "\\xe0\\x80\\x9b"},
        {"\xed\xa0\x80", "", "\\xed\\xa0\\x80"},
        {"\xf4\x90\x80\x80", "", "\\xf4\\x90\\x80\\x80"},
        {"\xe2\x88", "", "\\xe2\\x88"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char copy[64];
        mf_visible_copy(copy, sizeof copy, cases[k].text, cases[k].kept);
        assert_string_equal(copy, cases[k].expected);
    }
}

static void test_visible_copy_cuts_before_what_does_not_fit(void **state) {
    char copy[8];
    (void)state;
    static const char *const expected[] = {"",    "",    "a",   "ab",      "abc",
                                           "abc", "abc", "abc", "abc\\x1b"};
    for (size_t size = 1; size <= sizeof copy; size++) {
        memset(copy, 'x', sizeof copy);
        mf_visible_copy(copy, size, "abc\x1b!", "");
        assert_string_equal(copy, expected[size]);
    }
}

static void test_messages_have_no_control_characters(void **state) {
    (void)state;
    mf_status_fail(STATUS_IO, "a%sb\nc", "\x1b]0;title\a");
    assert_string_equal(mf_status_message(), "a\\x1b]0;title\\x07b\nc");
    mf_status_prefix(STATUS_IO, "%s", "\x1b");
    assert_string_equal(mf_status_message(), "\\x1b: a\\x1b]0;title\\x07b\nc");
}

static void test_visible_number_has_no_sign_of_nan(void **state) {
    char text[16];
    (void)state;
    snprintf(text, sizeof text, "%g", mf_visible_number(-(double)NAN));
    assert_string_equal(text, "nan");
    assert_true(mf_visible_number(-1.5) == -1.5 && mf_visible_number(-INFINITY) == -INFINITY);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_visible_copy_shows_control_characters),
        cmocka_unit_test(test_visible_copy_cuts_before_what_does_not_fit),
        cmocka_unit_test(test_messages_have_no_control_characters),
        cmocka_unit_test(test_visible_number_has_no_sign_of_nan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
