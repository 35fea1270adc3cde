// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_files.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <stdio.h>
#include <unistd.h>

#define RANGE ", \"r_minimum\": 0.5, \"r_maximum\": 1"
#define ERRORS ", \"error_file\": \"s.tsv\""

static const char good[] = "# t E E\n0 1 1\n0.1 0.9 0.5\n0.2 0.7 0\n";
static const char good_errors[] = "# t s s\n0 0 0\n0.1 0.01 0.02\n0.2 0.03 0\n";

/// Read a target from the members of its object; the status is that of the document.
static enum status read_members(void **state, const char *members, struct target_etd *target) {
    char text[2048];
    struct json_document *document;
    const int length = snprintf(text, sizeof text, "{\"etd\": {%s}}", members);
    assert_in_range(length, 1, sizeof text - 1);
    assert_ok(
        mf_json_open(&document, temporary_folder_write(*state, "a.json", text, (size_t)length)));
    struct json_object root = mf_json_root(document);
    struct json_object object = mf_json_child(&root, "etd", true);
    assert_ok(mf_target_etd_read(target, &object));
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

/// Read a target of these tables with more members of its object.
static enum status read_tables(void **state, const char *table, const char *errors,
                               const char *more, struct target_etd *target) {
    char members[512];
    temporary_folder_write(*state, "e.tsv", table, strlen(table));
    if (errors)
        temporary_folder_write(*state, "s.tsv", errors, strlen(errors));
    snprintf(members, sizeof members, "\"file\": \"e.tsv\"%s", more);
    return read_members(state, members, target);
}

static void assert_refused(void **state, const char *table, const char *errors, const char *members,
                           const char *part) {
    struct target_etd target;
    assert_fails(read_tables(state, table, errors, members, &target), STATUS_BAD_INPUT, part);
    assert_contains(mf_status_message(), "a.json: etd");
    assert_null(target.survival);
    mf_target_etd_clear(&target);
}

/// Whether what is measured at the target's times can be, with this time step.
static enum status steps_of(const struct target_etd *target, double time_step) {
    return mf_target_curve_check_steps(target->parameters.file, target->interval, target->time,
                                       time_step);
}

static void test_target_etd_read_takes_times_and_bins_from_the_shape(void **state) {
    struct target_etd target;
    assert_ok(read_tables(state, good, good_errors, RANGE ERRORS, &target));
    assert_int_equal(target.grid.times, 3);
    assert_int_equal(target.grid.bins, 2);
    assert_close(target.grid.r_minimum, 0.5, 0);
    assert_close(target.grid.r_maximum, 1, 0);
    assert_close(target.interval, 0.1, 1e-15);
    assert_close(target.survival[2], 0.9, 0);
    assert_close(target.survival[5], 0, 0);
    assert_close(target.error[3], 0.02, 0);
    assert_int_equal(target.left_out, 0);
    mf_target_etd_clear(&target);
}

static void test_target_etd_read_needs_no_errors(void **state) {
    struct target_etd target;
    assert_ok(read_tables(state, good, NULL, RANGE, &target));
    assert_close(target.error[4], 0, 0);
    assert_string_equal(target.parameters.error_file, "");
    mf_target_etd_clear(&target);
}

static void test_target_etd_read_leaves_out_what_is_not_known(void **state) {
    struct target_etd target;
    assert_ok(read_tables(state, "0 9 nan 1 1\n1 9 nan 0.9 0.5\n2 9 nan 0.7 0.4\n",
                          "0 9 nan 0 0\n1 9 nan 0.1 nan\n2 9 0 0.1 0\n",
                          RANGE ERRORS ", \"first_column\": 3", &target));
    assert_int_equal(target.grid.bins, 3);
    assert_int_equal(target.left_out, 4);
    assert_true(isnan(target.survival[0]) && isnan(target.error[6]));
    assert_true(isnan(target.survival[5]) && isnan(target.error[5]));
    assert_close(target.survival[4], 0.9, 0);
    mf_target_etd_clear(&target);
}

/// The atomistic target of the repository: times in ps and in τ, then 100 bins.
static void test_target_etd_read_takes_the_water_target(void **state) {
    char members[2000], folder[512];
    struct target_etd target;
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(members, sizeof members,
             "\"file\": \"%s/targets/spc-water/spc298_etd_E.txt\", "
             "\"error_file\": \"%s/targets/spc-water/spc298_etd_se.txt\", \"time_column\": 2, "
             "\"first_column\": 3, \"r_minimum\": 0.537634, \"r_maximum\": 1.075269",
             folder, folder);
    assert_ok(read_members(state, members, &target));
    assert_int_equal(target.grid.times, 101);
    assert_int_equal(target.grid.bins, 100);
    assert_int_equal(target.left_out, 0);
    assert_close(target.interval, 0.0159495, 1e-7);
    // As the target's table of bins has it: bin 11 after 1 ps.
    assert_close(target.survival[50 * 100 + 10], 0.930266, 1e-6);
    assert_close(target.error[50 * 100 + 10], 0.000856, 1e-6);
    assert_ok(steps_of(&target, 0.015949));
    assert_ok(steps_of(&target, 0.00797));
    mf_target_etd_clear(&target);
}

static void test_target_etd_read_refuses_what_is_no_escape_time_distribution(void **state) {
    assert_refused(state, good, NULL, ", \"r_minimum\": 0.5", "r_maximum");
    assert_refused(state, good, NULL, ", \"r_minimum\": 1, \"r_maximum\": 1",
                   "r_maximum 1 is not above r_minimum 1");
    assert_refused(state, good, NULL, RANGE ", \"colour\": 1", "colour");
    assert_refused(state, good, NULL, RANGE ", \"time_column\": 2",
                   "first_column 2 is not after time_column 2");
    assert_refused(state, good, NULL, RANGE ", \"first_column\": 4",
                   "e.tsv:2: 3 columns, at least 4");
    assert_refused(state, good, NULL, RANGE ", \"first_column\": 5",
                   "e.tsv:2: 3 columns, at least 4");
    assert_refused(state, "0 1\n", NULL, RANGE, "only one time");
    assert_refused(state, "0.1 1\n0.2 1\n", NULL, RANGE, "e.tsv:1: the times begin at 0.1");
    assert_refused(state, "0 1\n0.1 1\n0.1 1\n", NULL, RANGE, "e.tsv:3: column 1");
    assert_refused(state, "0 1\n0.1 1\n0.2 1\n0.4 1\n", NULL, RANGE,
                   "the times are not equally spaced");
    assert_refused(state, "0 1\nnan 1\n", NULL, RANGE, "e.tsv:2: column 1: \"nan\"");
    assert_refused(state, "0 1 1\n0.1 1 1.01\n", NULL, RANGE,
                   "e.tsv:2: column 3: 1.01 is not from 0 to 1");
    assert_refused(state, "0 1 1\n0.1 -0.1 1\n", NULL, RANGE,
                   "e.tsv:2: column 2: -0.1 is not from 0 to 1");
    assert_refused(state, "0 1 0.9\n0.1 1 0.9\n", NULL, RANGE,
                   "e.tsv:1: column 3: 0.9 is not 1 at time 0");
    assert_refused(state, "0 nan\n0.1 nan\n", NULL, RANGE, "all values are nan");
    assert_refused(state, "0 1\n0.1 inf\n", NULL, RANGE, "e.tsv:2: column 2");
}

static void test_target_etd_read_refuses_errors_that_do_not_belong_to_it(void **state) {
    assert_refused(state, good, NULL, RANGE ERRORS, "s.tsv");
    assert_refused(state, good, "0 0 0\n0.1 0 0\n", RANGE ERRORS,
                   "s.tsv: 2 rows and 3 columns, but 3 and 3");
    assert_refused(state, good, "0 0\n0.1 0\n0.2 0\n", RANGE ERRORS,
                   "3 rows and 2 columns, but 3 and 3");
    assert_refused(state, good, "0 0 0\n0.1 0 -1\n0.2 0 0\n", RANGE ERRORS,
                   "s.tsv:2: column 3: -1 is not a standard error");
    assert_refused(state, good, "0 0 0\n0.11 0 0\n0.22 0 0\n", RANGE ERRORS,
                   "s.tsv:2: time 0.11, but 0.1");
}

static void test_target_curve_check_steps_names_the_time_steps_that_would_do(void **state) {
    struct target_etd target;
    assert_ok(read_tables(state, good, NULL, RANGE, &target));
    assert_ok(steps_of(&target, 0.1));
    assert_ok(steps_of(&target, 0.10009));
    assert_ok(steps_of(&target, 0.02));
    assert_fails(steps_of(&target, 0.04), STATUS_BAD_INPUT,
                 "2.5 time steps of 0.04: not a whole number, as it would be with a time step of "
                 "0.0333333 or 0.05");
    assert_fails(steps_of(&target, 0.1002), STATUS_BAD_INPUT, "with a time step of 0.1");
    assert_fails(steps_of(&target, 7), STATUS_BAD_INPUT, "with a time step of 0.1");
    mf_target_etd_clear(&target);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_target_etd_read_takes_times_and_bins_from_the_shape),
        TEST(test_target_etd_read_needs_no_errors),
        TEST(test_target_etd_read_leaves_out_what_is_not_known),
        TEST(test_target_etd_read_takes_the_water_target),
        TEST(test_target_etd_read_refuses_what_is_no_escape_time_distribution),
        TEST(test_target_etd_read_refuses_errors_that_do_not_belong_to_it),
        TEST(test_target_curve_check_steps_names_the_time_steps_that_would_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
