// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/nearest.h"
#include "shared/testing.h"

static const char *const known[] = {"seed", "steps", "temperature", "x"};

static void assert_nearest(const char *given, const char *expected) {
    const char *nearest = mf_nearest_name(given, known, 4);
    if (expected == NULL)
        assert_null(nearest);
    else {
        assert_non_null(nearest);
        assert_string_equal(nearest, expected);
    }
}

static void test_nearest_name_finds_the_name_when_one_slip_was_made(void **state) {
    (void)state;
    assert_nearest("sed", "seed");
    assert_nearest("seedd", "seed");
    assert_nearest("seet", "seed");
    assert_nearest("sede", "seed");
    assert_nearest("Seed", "seed");
    assert_nearest("SEED", "seed");
    assert_nearest("TEMPRATURE", "temperature");
    assert_nearest("temprature", "temperature");
    assert_nearest("tempretrue", "temperature");
}

static void test_nearest_name_finds_nothing_when_too_far(void **state) {
    (void)state;
    assert_nearest("bead", NULL);
    assert_nearest("y", NULL);
    assert_nearest("", NULL);
    assert_nearest("pressure", NULL);
    assert_null(mf_nearest_name("seed", known, 0));
}

static void test_nearest_name_is_the_only_one_that_begins_so(void **state) {
    (void)state;
    assert_nearest("temp", "temperature");
    assert_nearest("Te", "temperature");
    assert_nearest("s", NULL);
    assert_nearest("se", "seed");
    static const char *const axes[] = {"periodic", "period_of_noise"};
    assert_null(mf_nearest_name("per", axes, 2));
}

static void test_nearest_name_prefers_the_same_letters(void **state) {
    static const char *const axes[] = {"y", "xy", "yz"};
    (void)state;
    assert_string_equal(mf_nearest_name("zy", axes, 3), "yz");
    assert_string_equal(mf_nearest_name("yx", axes, 3), "xy");
    assert_string_equal(mf_nearest_name("yy", axes, 3), "y");
}

static void test_nearest_name_finds_nothing_when_the_name_is_very_long(void **state) {
    (void)state;
    char given[1000];
    memset(given, 's', sizeof given - 1);
    given[sizeof given - 1] = '\0';
    assert_nearest(given, NULL);
}

/// A name of the greatest length that is compared, of which no letter is known.
static void test_nearest_name_finds_nothing_when_no_letter_is_the_same(void **state) {
    (void)state;
    char name[64] = "";
    for (int k = 0; k < 63; k++) {
        name[k] = 'q';
        assert_null(mf_nearest_name(name, known, 4));
    }
}

static void test_nearest_hint_lists_the_known_when_nothing_is_near(void **state) {
    (void)state;
    char text[64], small[12];
    mf_nearest_hint("sed", known, 4, text, sizeof text);
    assert_string_equal(text, "did you mean \"seed\"?");
    mf_nearest_hint("pressure", known, 4, text, sizeof text);
    assert_string_equal(text, "known: seed, steps, temperature, x");
    mf_nearest_hint("pressure", known, 4, small, sizeof small);
    assert_string_equal(small, "known: seed");
    mf_nearest_hint("pressure", known, 0, text, sizeof text);
    assert_string_equal(text, "no name is known here");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nearest_name_finds_the_name_when_one_slip_was_made),
        cmocka_unit_test(test_nearest_name_finds_nothing_when_too_far),
        cmocka_unit_test(test_nearest_name_finds_nothing_when_the_name_is_very_long),
        cmocka_unit_test(test_nearest_name_finds_nothing_when_no_letter_is_the_same),
        cmocka_unit_test(test_nearest_name_is_the_only_one_that_begins_so),
        cmocka_unit_test(test_nearest_name_prefers_the_same_letters),
        cmocka_unit_test(test_nearest_hint_lists_the_known_when_nothing_is_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
