// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "base/names.h"
#include "shared/testing.h"

#include <stdio.h>

enum { RECORDS = 40 };

struct record {
    const char *name;
    int number;
};

/// Records "0" to "39".
struct records {
    struct record record[RECORDS];
    char name[RECORDS][8];
    const struct record *list[RECORDS + 1];
};

static void fill(struct records *records) {
    *records = (struct records){0};
    for (int k = 0; k < RECORDS; k++) {
        snprintf(records->name[k], sizeof records->name[k], "%d", k);
        records->record[k] = (struct record){records->name[k], k};
        records->list[k] = &records->record[k];
    }
}

static void test_names_find_gives_the_record_or_null(void **state) {
    (void)state;
    struct records records;
    fill(&records);
    for (int k = 0; k < RECORDS; k++)
        assert_ptr_equal(mf_names_find(records.list, records.name[k]), &records.record[k]);
    assert_null(mf_names_find(records.list, "40"));
    assert_null(mf_names_find(records.list, ""));
    assert_null(mf_names_find(&records.list[RECORDS], "0"));
}

static void test_names_collect_gives_all_when_there_are_many(void **state) {
    (void)state;
    struct records records;
    const char **names = NULL;
    fill(&records);
    assert_ok(mf_names_collect(records.list, NULL, &names));
    for (int k = 0; k < RECORDS; k++)
        assert_string_equal(names[k], records.name[k]);
    assert_null(names[RECORDS]);
    mf_memory_free(names);
    assert_ok(mf_names_collect(records.list, "none", &names));
    assert_string_equal(names[0], "none");
    for (int k = 0; k < RECORDS; k++)
        assert_string_equal(names[k + 1], records.name[k]);
    assert_null(names[RECORDS + 1]);
    mf_memory_free(names);
}

static void test_names_that_tables_have_are_found(void **state) {
    static const char *const own[] = {"now_A",   "error_ring", "B_history",
                                      "B_flat",  "x_error",    "A_boltzmann",
                                      "B_lower", "B_upper",    "_history"};
    static const char *const plain[] = {"A",      "now",      "history",  "error", "B_historyA",
                                        "Anow_B", "A_lower1", "flat_cat", ""};
    (void)state;
    for (size_t k = 0; k < sizeof own / sizeof *own; k++)
        assert_true(mf_names_is_reserved(own[k]));
    for (size_t k = 0; k < sizeof plain / sizeof *plain; k++)
        assert_false(mf_names_is_reserved(plain[k]));
}

static void test_plain_names_have_letters_digits_and_marks(void **state) {
    (void)state;
    char name[8];
    mf_names_adapt("[NH3+]-C*'1", "_-", name, sizeof name);
    assert_string_equal(name, "_NH3__-");
    assert_true(mf_names_is_plain("Ring_2", "_", 7));
    assert_false(mf_names_is_plain("Ring_2", "_", 6));
    assert_false(mf_names_is_plain("a-b", "_", 9));
    assert_true(mf_names_is_plain("a-b", "_-", 9));
    assert_false(mf_names_is_plain("", "_", 9));
    assert_false(mf_names_is_plain("a/b", "_-.", 9));
    assert_false(mf_names_is_plain("\xe4", "_", 9)); // a letter in some locales
}

static void test_paths_are_one_with_a_pair_in_either_order(void **state) {
    (void)state;
    assert_true(mf_names_are_one_path("a.A-B.k", "a.A-B.k"));
    assert_true(mf_names_are_one_path("a.A-B.k", "a.B-A.k"));
    assert_true(mf_names_are_one_path("a.Na_1-W.k", "a.W-Na_1.k"));
    assert_false(mf_names_are_one_path("a.A-B.k", "a.B-B.k"));
    assert_false(mf_names_are_one_path("a.A-B.k", "a.B-A.n"));
    assert_false(mf_names_are_one_path("a.A-B.k", "a.B-A"));
    assert_false(mf_names_are_one_path("a.A-B", "a.AB-"));
    assert_false(mf_names_are_one_path("a", "b"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_that_tables_have_are_found),
        cmocka_unit_test(test_plain_names_have_letters_digits_and_marks),
        cmocka_unit_test(test_names_find_gives_the_record_or_null),
        cmocka_unit_test(test_paths_are_one_with_a_pair_in_either_order),
        cmocka_unit_test(test_names_collect_gives_all_when_there_are_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
