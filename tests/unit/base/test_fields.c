// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/fields.h"
#include "shared/is_close.h"
#include "shared/testing.h"

struct sample {
    double strength;
    int64_t steps;
    uint64_t seed;
    double lengths[3];
    char name[FIELD_TEXT_SIZE], file[FIELD_TEXT_SIZE];
    int kind;
};

static const char *const kinds[] = {"soft", "hard", NULL};

static const struct field fields[] = {
    {"strength", FIELD_NUMBER, offsetof(struct sample, strength), false, 0.1, 0, 1, NULL, "k_B T",
     "how strong"},
    {"steps", FIELD_INTEGER, offsetof(struct sample, steps), true, -7, -10, 10, NULL, "",
     "a count"},
    {"seed", FIELD_SEED, offsetof(struct sample, seed), false, 42, 0, 0, NULL, "", "a seed"},
    {"lengths", FIELD_LENGTHS, offsetof(struct sample, lengths), false, 0, FIELD_ABOVE_ZERO,
     DBL_MAX, NULL, "", "box"},
    {"name", FIELD_TEXT, offsetof(struct sample, name), false, 0, 0, 0, NULL, "", "a name"},
    {"file", FIELD_FILE, offsetof(struct sample, file), false, 0, 0, 0, NULL, "", "a file"},
    {"kind", FIELD_CHOICE, offsetof(struct sample, kind), false, 1, 0, 0, kinds, "", "a kind"},
    FIELD_END,
};

static void test_fields_set_defaults_fills_every_member_when_struct_holds_rubbish(void **state) {
    (void)state;
    struct sample sample;
    memset(&sample, 0x5A, sizeof sample);
    mf_fields_set_defaults(fields, &sample);
    assert_identical(sample.strength, 0.1);
    assert_int_equal(sample.steps, -7);
    assert_int_equal(sample.seed, 42);
    for (int k = 0; k < 3; k++)
        assert_identical(sample.lengths[k], 0.0);
    assert_string_equal(sample.name, "");
    assert_string_equal(sample.file, "");
    assert_int_equal(sample.kind, 1);
}

static void test_fields_range_text_names_both_ends_when_they_are_bounded(void **state) {
    (void)state;
    static const struct {
        double minimum, maximum;
        const char *text;
    } cases[] = {
        {0, 1, "0 to 1"},
        {-2, 2.5, "-2 to 2.5"},
        {0, DBL_MAX, "at least 0"},
        {3, FIELD_LARGEST_INTEGER, "at least 3"},
        {FIELD_ABOVE_ZERO, DBL_MAX, "above 0"},
        {FIELD_ABOVE_ZERO, 5, "above 0, at most 5"},
        {-DBL_MAX, DBL_MAX, "any"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct field field = {.minimum = cases[k].minimum, .maximum = cases[k].maximum};
        char text[64];
        mf_fields_range_text(&field, text, sizeof text);
        assert_string_equal(text, cases[k].text);
    }
}

static void test_fields_choice_index_finds_exact_names_when_asked(void **state) {
    (void)state;
    assert_int_equal(mf_fields_choice_index(&fields[6], "soft"), 0);
    assert_int_equal(mf_fields_choice_index(&fields[6], "hard"), 1);
    assert_int_equal(mf_fields_choice_index(&fields[6], "Hard"), -1);
    assert_int_equal(mf_fields_choice_index(&fields[6], "har"), -1);
    assert_int_equal(mf_fields_choice_index(&fields[6], ""), -1);
}

static void test_fields_describe_prints_unit_default_and_range_when_they_exist(void **state) {
    (void)state;
    char text[4096] = "";
    FILE *stream = fmemopen(text, sizeof text, "w");
    assert_non_null(stream);
    mf_fields_describe(fields, stream);
    fclose(stream);
    assert_contains(text, "how strong, in k_B T");
    assert_contains(text, "number, default 0.1");
    assert_contains(text, "range: 0 to 1");
    assert_contains(text, "integer, required");
    assert_contains(text, "soft|hard, default hard");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fields_set_defaults_fills_every_member_when_struct_holds_rubbish),
        cmocka_unit_test(test_fields_range_text_names_both_ends_when_they_are_bounded),
        cmocka_unit_test(test_fields_choice_index_finds_exact_names_when_asked),
        cmocka_unit_test(test_fields_describe_prints_unit_default_and_range_when_they_exist),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
