// SPDX-License-Identifier: GPL-3.0-or-later
//
// Messages name the methods that can do what another cannot as their records say.
#include "defaults/methods.h"
#include "shared/testing.h"

#include <string.h>

static bool is_the_second(const struct inverse_method *method) {
    return method == mf_methods[1];
}

static bool is_one_of_the_first_three(const struct inverse_method *method) {
    return method == mf_methods[0] || method == mf_methods[1] || method == mf_methods[2];
}

static bool is_any(const struct inverse_method *method) {
    return method != NULL;
}

static bool is_none(const struct inverse_method *method) {
    return method == NULL;
}

static void test_methods_are_listed_in_words(void **state) {
    (void)state;
    char text[METHODS_TEXT_SIZE];
    assert_string_equal(mf_methods_list(is_none, text), "");
    assert_string_equal(mf_methods_list(is_the_second, text), "\"imc\"");
    assert_string_equal(mf_methods_list(is_one_of_the_first_three, text),
                        "\"auto\", \"imc\" and \"ibi\"");
}

/// All of them have room, and what simulates candidates fits what inversions do not.
static void test_methods_all_stand_in_a_list(void **state) {
    (void)state;
    char all[METHODS_TEXT_SIZE], some[METHODS_TEXT_SIZE], name[64];
    mf_methods_list(is_any, all);
    mf_methods_list(mf_methods_fits_any_target, some);
    for (size_t k = 0; mf_methods[k]; k++) {
        snprintf(name, sizeof name, "\"%s\"", mf_methods[k]->name);
        assert_non_null(strstr(all, name));
        assert_int_equal(strstr(some, name) != NULL, mf_methods[k]->kind == INVERSE_MATCHING);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_methods_are_listed_in_words),
        cmocka_unit_test(test_methods_all_stand_in_a_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
