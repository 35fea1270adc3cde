// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/votca.h"

#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

static const char *put(void **state, const char *text) {
    return temporary_folder_write(*state, "a.pot", text, strlen(text));
}

static void assert_refused(void **state, const char *text, const char *part) {
    struct votca_table table;
    assert_fails(mf_votca_read(&table, put(state, text)), STATUS_BAD_INPUT, part);
    assert_null(table.x);
}

static void test_votca_read_takes_the_rows_in_range(void **state) {
    struct votca_table table;
    assert_ok(mf_votca_read(&table, put(state, "# made by hand\n0 nan u\n0.1 1e6 o\n0.2 3.5 i\n"
                                               "0.3 -1 i\n0.4 0 i\n0.5 0 o\n")));
    assert_int_equal(table.rows, 3);
    assert_false(table.has_error);
    assert_identical(table.x[0], 0.2);
    assert_identical(table.y[1], -1);
    assert_identical(table.error[2], 0);
    assert_int_equal(table.line[0], 4);
    mf_votca_clear(&table);
    assert_null(table.x);
}

static void test_votca_read_takes_errors_when_there_are_four_columns(void **state) {
    struct votca_table table;
    assert_ok(mf_votca_read(&table, put(state, "0.2 3.5 0.1 i\n0.3 -1 0.2 i\n")));
    assert_int_equal(table.rows, 2);
    assert_true(table.has_error);
    assert_identical(table.error[1], 0.2);
    mf_votca_clear(&table);
}

static void test_votca_read_takes_two_columns_without_flags(void **state) {
    struct votca_table table;
    assert_ok(mf_votca_read(&table, put(state, "0 0\n0.1 0.5\n0.2 1.5\n")));
    assert_int_equal(table.rows, 3);
    assert_false(table.has_error);
    assert_identical(table.x[1], 0.1);
    assert_identical(table.y[2], 1.5);
    assert_int_equal(table.line[2], 3);
    mf_votca_clear(&table);
}

static void test_votca_read_refuses_what_is_no_table_of_votca(void **state) {
    assert_refused(state, "0.1 1 i\n0.2 1 u\n0.3 1 i\n", "a.pot:2: flagged u between");
    assert_refused(state, "0.1 1 i\n0.2 1 x\n", "a.pot:2: the flag \"x\" is not i, o or u");
    assert_refused(state, "0.1 1 i\n0.2 1 ii\n", "a.pot:2: expected a flag i, o or u of VOTCA");
    assert_refused(state, "0.1 1 2\n", "a.pot:1: expected a flag i, o or u of VOTCA");
    assert_refused(state, "0.1 1 u\n", "no row is flagged i");
    assert_refused(state, "0.1 nan i\n", "a.pot:1: column 2: nan");
    assert_refused(state, "0.1 1 2 3 i\n", "a.pot:1: not \"x y flag\"");
    assert_refused(state, "0.1 i\n", "a.pot:1: not \"x y flag\"");
    assert_refused(state, "0.1 1 i\n0.2 i\n", "a.pot:2");
    assert_refused(state, "", "the file is empty");
}

static void test_votca_write_is_read_again_without_what_it_continued(void **state) {
    const double x[] = {0.1, 0.2, 0.3}, y[] = {1e3, -0.123456789, 0};
    const char *file = put(state, "");
    struct votca_table table;
    assert_ok(mf_votca_write(file, x, y, (struct votca_scale){1, 1}, 3, 1));
    assert_ok(mf_votca_read(&table, file));
    assert_int_equal(table.rows, 2);
    assert_identical(table.x[0], 0.2);
    assert_identical(table.y[0], -0.123456789);
    mf_votca_clear(&table);
}

#define TEST(function)                                                                             \
    cmocka_unit_test_setup_teardown(function, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_votca_read_takes_the_rows_in_range),
        TEST(test_votca_read_takes_errors_when_there_are_four_columns),
        TEST(test_votca_read_takes_two_columns_without_flags),
        TEST(test_votca_read_refuses_what_is_no_table_of_votca),
        TEST(test_votca_write_is_read_again_without_what_it_continued),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
