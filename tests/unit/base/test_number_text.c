// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/number_text.h"
#include "shared/testing.h"

#include <math.h>

static void test_number_text_has_two_digits_of_its_error(void **state) {
    (void)state;
    static const struct {
        double value, error;
        const char *expected;
    } cases[] = {
        {2.5814, 0.0341, "2.581(34)"},
        {0.0093, 0.000012, "0.009300(12)"},
        {2.5814, 0.0996, "2.58(10)"},
        {23.649, 1.26, "23.6(1.3)"},
        {4523.4, 12.3, "4523(12)"},
        {4523.4, 123, "4523(123)"},
        {-0.4213, 0.0059, "-0.4213(59)"},
        {2.58e-5, 3.4e-7, "2.580(34)e-5"},
        {1.234e8, 5.6e6, "1.234(56)e8"},
        {0, 0.012, "0.000(12)"},
        {2.58149, 0, "2.581"},
        {2.58149, NAN, "2.581"},
        {NAN, 0.1, "nan"},
        {2.58149, INFINITY, "2.581"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[NUMBER_TEXT_SIZE];
        mf_number_text(cases[k].value, cases[k].error, text);
        assert_string_equal(text, cases[k].expected);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_number_text_has_two_digits_of_its_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
