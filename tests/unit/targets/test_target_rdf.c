// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_rdf.h"
#include "problem/targets.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// λ is half a nanometre, k_B T_0 2.5 kJ/mol.
static const struct units units = {.length = 0.5, .temperature = 300.68, .mass = 1e-26};

/// Read the target `table` with more members of its object; the status is that of the document.
static enum status read(void **state, const char *table, const char *members,
                        struct target_rdf *target) {
    char text[512];
    struct json_document *document;
    temporary_folder_write(*state, "g.tsv", table, strlen(table));
    const int length = snprintf(text, sizeof text, "{\"rdf\": {\"file\": \"g.tsv\"%s}}", members);
    assert_ok(
        mf_json_open(&document, temporary_folder_write(*state, "a.json", text, (size_t)length)));
    struct json_object root = mf_json_root(document);
    struct json_object object = mf_json_child(&root, "rdf", true);
    assert_ok(mf_target_rdf_read(target, &object, &units, 3));
    mf_json_finish(&root);
    return mf_json_close(document, STATUS_OK);
}

static void assert_refused(void **state, const char *table, const char *members, const char *part) {
    struct target_rdf target;
    assert_fails(read(state, table, members, &target), STATUS_BAD_INPUT, part);
    assert_contains(mf_status_message(), "a.json: rdf");
    mf_target_rdf_clear(&target);
}

static void test_target_read_takes_the_bins_from_their_centres(void **state) {
    struct target_rdf target;
    assert_ok(
        read(state, "# r g\n0.05 0 0\n0.15 0.5 0.1\n0.25 1.5 0.2\n0.35 1 0.3\n", "", &target));
    assert_int_equal(target.bins.count, 4);
    assert_close(target.bins.low, 0, 0);
    assert_close(target.bins.width, 0.1, 1e-15);
    assert_close(target.g[2], 1.5, 0);
    assert_close(target.error[3], 0.3, 0);
    mf_target_rdf_clear(&target);
}

/// A comment of `simulate` and `measure`, which a run file may contradict.
static void test_target_read_takes_what_the_table_says_of_its_errors(void **state) {
#define FOUR_ROWS "# r g g_error\n0.05 0 0\n0.15 0.5 0.1\n0.25 1.5 0.2\n0.35 1 0.3\n"
    static const struct {
        const char *table, *members;
        enum target_errors of;
    } cases[] = {
        {FOUR_ROWS, "", TARGET_ERRORS_UNKNOWN},
        {"# errors of samples\n" FOUR_ROWS, "", TARGET_ERRORS_OF_SAMPLES},
        {"# not errors of samples\n" FOUR_ROWS, "", TARGET_ERRORS_UNKNOWN},
        {"# errors of samples\n" FOUR_ROWS, ", \"error_column\": 0", TARGET_ERRORS_UNKNOWN},
        {"# errors of samples\n" FOUR_ROWS, ", \"errors_of\": \"bins\"", TARGET_ERRORS_OF_BINS}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct target_rdf target;
        assert_ok(read(state, cases[k].table, cases[k].members, &target));
        assert_int_equal(target.parameters.errors_of, cases[k].of);
        mf_target_rdf_clear(&target);
    }
}

/// What lies beyond a cutoff is kept for a look at the state, as if it ended at 1.
static void test_target_read_keeps_the_whole_beside_what_is_cut(void **state) {
    struct target_rdf target;
    static const char table[] =
        "0.05 0 0\n0.15 0.5 0.1\n0.25 1.5 0.2\n0.35 1 0.3\n0.45 2 0.3\n0.55 1.25 0.3\n";
    assert_ok(read(state, table, ", \"cutoff\": 0.4", &target));
    assert_int_equal(target.bins.count, 4);
    assert_int_equal(target.whole.bins.count, 6);
    assert_close(target.whole.g[4], 2 / 1.25, 1e-15);
    assert_close(target.g[2], 1.5, 0);
    mf_target_rdf_clear(&target);
    assert_ok(read(state, table, ", \"cutoff\": 0.4, \"error_column\": 0", &target));
    assert_int_equal(target.whole.bins.count, 0);
    mf_target_rdf_clear(&target);
}

static void test_target_read_lets_the_first_bin_begin_above_0(void **state) {
    struct target_rdf target;
    assert_ok(read(state, "0.25 0 0\n0.35 0.5 0\n0.45 1.5 0\n0.55 1 0\n", "", &target));
    assert_close(target.bins.low, 0.2, 1e-15);
    mf_target_rdf_clear(&target);
}

/// LAMMPS's fix ave/time of compute rdf: step and rows, then a row's number, r, g and the
/// neighbours so far, which are no errors.
static void test_target_read_takes_g_of_fix_ave_time(void **state) {
    struct target_rdf target;
    assert_ok(read(state,
                   "# Time-averaged data for fix r\n# TimeStep Number-of-rows\n"
                   "# Row c_r[1] c_r[2] c_r[3]\n60000 4\n1 0.05 0 0\n2 0.15 0.5 1\n"
                   "3 0.25 1.5 4\n4 0.35 1 9\n",
                   "", &target));
    assert_close(target.bins.low, 0, 0);
    assert_close(target.bins.width, 0.1, 1e-15);
    assert_close(target.g[2], 1.5, 0);
    assert_close(target.error[3], 0.002, 1e-15); // none is given
    mf_target_rdf_clear(&target);
    assert_refused(state, "1 0.05 0 0\n2 0.15 0.5 1\n3 0.25 1.5 4\n4 0.35 1 9\n", "",
                   "g.tsv: column 1 numbers the rows, and column 2 increases as r does");
    assert_refused(state, ",r,g\n0,0.05,0\n1,0.15,0.5\n2,0.25,1.5\n3,0.35,1\n", "",
                   "g.tsv: column 1 numbers the rows, and column 2 increases as r does");
}

static void test_target_read_forgives_the_rounding_of_the_file(void **state) {
    struct target_rdf target;
    // Bins of 1/300, given with five decimals.
    assert_ok(read(state, "0.00167 0 0\n0.005 0.5 0\n0.00833 1.5 0\n0.01167 1 0\n0.015 1 0\n", "",
                   &target));
    assert_close(target.bins.low, 0, 0);
    assert_close_relative(target.bins.width, 1.0 / 300, 1e-3);
    mf_target_rdf_clear(&target);
}

static void test_target_read_takes_the_columns_it_is_told(void **state) {
    struct target_rdf target;
    static const char table[] = "9 0.1 8 0.5\n9 0.2 8 1.5\n9 0.3 8 1\n9 0.4 8 2\n";
    assert_ok(
        read(state, table, ", \"r_column\": 2, \"g_column\": 4, \"error_column\": 0", &target));
    assert_close(target.bins.low, 0.05, 1e-15);
    assert_close(target.g[3], 2, 0);
    // No errors, and too few rows to tell their scatter: 0.002 at g = 1 in the last bin.
    assert_close(target.error[3], 0.002 * sqrt(2), 1e-15);
    mf_target_rdf_clear(&target);
    assert_refused(state, table, ", \"g_column\": 5", "g.tsv:1: 4 columns, at least 5");
    assert_refused(state, table, ", \"r_column\": 0", "rdf.r_column: 0 is out of range");
}

/// A row that is missing is read by its neighbours; of a wider gap the line after it is named.
static void test_target_read_names_the_line_behind_a_gap(void **state) {
    enum { BINS = 20, WIDE = 6 };
    for (int gap = 1; gap < BINS - WIDE; gap++)
        for (int wide = 1; wide <= WIDE; wide += WIDE - 1) {
            char table[1024] = "# r g error\n", where[128];
            struct target_rdf target;
            for (int k = 0; k < BINS; k++)
                if (k < gap || k >= gap + wide)
                    snprintf(table + strlen(table), sizeof table - strlen(table), "%g 1 0\n",
                             0.1 * k + 0.05);
            snprintf(where, sizeof where, "g.tsv:%d: a gap in r of ", gap + 2);
            if (wide > 1) {
                assert_refused(state, table, "", where);
                continue;
            }
            assert_ok(read(state, table, "", &target));
            assert_int_equal(target.resampling.points, BINS - 1);
            assert_close(target.g[gap], 1, 1e-12);
            mf_target_rdf_clear(&target);
        }
}

/// A digitised core scatters about 0; a potential is below it.
static void test_target_read_takes_a_g_slightly_below_0_as_0(void **state) {
    struct target_rdf target;
    assert_ok(read(state, "0.05 -0.004\n0.15 0.002\n0.25 -0.02\n0.35 1.5\n0.45 1\n", "", &target));
    assert_int_equal(target.negative, 2);
    assert_close(target.min, -0.02, 0);
    assert_close(target.g[0] + target.g[2], 0, 0);
    mf_target_rdf_clear(&target);
    assert_refused(state, "0.05 0\n0.15 0\n0.25 -0.04\n0.35 1.5\n0.45 1\n", "",
                   "g.tsv:3: a negative g, -0.04: a potential, or another column than g?");
    // Within three of its own errors.
    assert_ok(read(state, "0.05 0 0\n0.15 0 0\n0.25 -0.04 0.02\n0.35 1.5 0.1\n0.45 1 0.1\n", "",
                   &target));
    assert_int_equal(target.negative, 1);
    mf_target_rdf_clear(&target);
}

static void test_target_read_refuses_what_is_no_g_of_r(void **state) {
    assert_refused(state, "0.1 1 0\n0.3 1 0\n0.2 1 0\n0.4 1 0\n", "", "g.tsv:3: column 1");
    assert_refused(state, "0.1 1 0\n0.1 1 0\n0.2 1 0\n0.4 1 0\n", "", "g.tsv:2: column 1");
    assert_refused(state, "-0.1 1 0\n0 1 0\n0.1 1 0\n0.2 1 0\n", "", "-0.1 is below 0");
    assert_refused(state, "0 1 0\n0.1 1 0\n0.2 1 0\n0.3 1 0\n", "",
                   "g.tsv:1: r = 0 is not the centre of a bin: half a bin that is not empty; leave "
                   "the row out");
    assert_refused(state, "0.1 1 0\n0.2 1 0\n0.3 1 0\n", "", "only 3 bins");
    assert_refused(state, "0.1 1 0\n", "", "only 1 bin;");
    assert_refused(state, "0.1 1 0\n0.2 -1 0\n0.3 1 0\n0.4 1 0\n", "", "g.tsv:2: a negative");
    assert_refused(state, "0.1 1 0\n0.2 1 -1\n0.3 1 0\n0.4 1 0\n", "", "g.tsv:2: a negative");
    assert_refused(state, "0.1 1 0\n0.2 1e999 0\n0.3 1 0\n0.4 1 0\n", "", "g.tsv:2: column 2");
}

static void test_target_read_leaves_the_empty_half_bin_out(void **state) {
    struct target_rdf target;
    // The grid of gmx rdf, two columns, "&" at the end.
    assert_ok(read(state,
                   "@ title \"g\"\n@TYPE xy\n0.000 0\n0.002 0\n0.004 0.5\n0.006 1.5\n0.008 1\n&\n",
                   "", &target));
    assert_int_equal(target.bins.count, 4);
    assert_close(target.bins.low, 0.001, 1e-12);
    assert_close(target.bins.width, 0.002, 1e-12);
    assert_close(target.g[1], 0.5, 0);
    mf_target_rdf_clear(&target);
}

static void test_target_read_takes_comma_separated_columns_with_names(void **state) {
    struct target_rdf target;
    assert_ok(
        read(state, "r,g,err\n0.05,0,0\n0.15,0.5,0.1\n0.25,1.5,0.2\n0.35,1,0.3\n", "", &target));
    assert_close(target.g[2], 1.5, 0);
    assert_close(target.error[2], 0.2, 0);
    assert_close(target.estimated_error, 0, 0);
    mf_target_rdf_clear(&target);
}

static void test_target_read_refuses_errors_that_are_none(void **state) {
    // Three columns as gmx rdf -cn, pasted, has them: neighbours up to r.
    assert_refused(state, "0.1 0 0\n0.2 0.5 0.1\n0.3 1.5 0.9\n0.4 1 1.8\n", "",
                   "column 3 cannot be the standard error of g: it increases");
    // Those of a short measurement, which say what they are.
    struct target_rdf target;
    assert_ok(
        read(state, "# r g g_error\n0.1 0 0\n0.2 0.5 1.1\n0.3 1.5 0.9\n0.4 1 0.98\n", "", &target));
    assert_close(target.error[2], 0.9, 0);
    mf_target_rdf_clear(&target);
    // The g of other pairs.
    assert_refused(
        state, "0.1 0 0\n0.2 0.5 1.1\n0.3 1.5 0.9\n0.4 1 0.98\n", "",
        "column 3 cannot be the standard error of g: it is as large as g; set \"error_column\"");
    assert_refused(state, "0.1 0 0\n0.2 0.5 0.1\n0.3 1.5 nan\n0.4 1 0.1\n", "",
                   "g.tsv:3: column 3: \"nan\"");
    assert_refused(state, "0.1 0\n0.2 0.5\n0.3 1.5\n0.4 1\n", ", \"error_column\": 3",
                   "g.tsv:1: 2 columns, at least 3 are needed for \"error_column\"; 0 if");
}

/// Eight rows of width 0.1, 0.1 the half-width of VOTCA's first: joined in pairs.
static void test_target_read_joins_rows_to_the_width_that_is_asked_for(void **state) {
    struct target_rdf target;
    static const char table[] = "0.05 0 0\n0.15 0 0\n0.25 1 0.1\n0.35 2 0.1\n0.45 1 0.1\n"
                                "0.55 1 0.1\n0.65 1 0.1\n0.75 1 0.1\n0.85 1 0.1\n";
    assert_ok(read(state, table, ", \"bin_width\": 0.21", &target));
    assert_int_equal(target.joined, 2);
    assert_int_equal(target.bins.count, 4);
    assert_close(target.bins.low, 0, 0);
    assert_close(target.bins.width, 0.2, 1e-12);
    // Shells of 0.2 to 0.3 and 0.3 to 0.4 have the volumes 19 and 37.
    assert_close(target.g[1], (19 * 1 + 37 * 2) / 56.0, 1e-12);
    assert_close(target.error[1], 0.1 * sqrt(19 * 19 + 37 * 37) / 56, 1e-12);
    mf_target_rdf_clear(&target);
    assert_ok(read(state, table, ", \"bin_width\": 0.02", &target));
    assert_int_equal(target.bins.count, 9);
    mf_target_rdf_clear(&target);
}

static void test_target_read_joins_rows_by_itself_when_there_are_too_many(void **state) {
    enum { ROWS = 1001 };
    struct target_rdf target;
    char *table = calloc(ROWS, 32);
    size_t length = 0;
    for (int k = 0; k < ROWS; k++)
        length += (size_t)sprintf(table + length, "%.4f %d\n", 0.002 * k, k > 200);
    assert_ok(read(state, table, "", &target));
    assert_int_equal(target.joined, 3);
    assert_int_equal(target.bins.count, 333);
    assert_close(target.bins.low, 0.001, 1e-9);
    assert_close(target.bins.width, 0.006, 1e-9);
    // A step has no scatter; what is assumed is assumed of the bins.
    assert_true(target.assumed);
    assert_close(target.error[332], 0.002, 1e-9);
    mf_target_rdf_clear(&target);
    assert_ok(read(state, table, ", \"cutoff\": 0.7", &target));
    assert_int_equal(target.joined, 1);
    assert_int_equal(target.bins.count, 350);
    mf_target_rdf_clear(&target);
    free(table);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

#define VOTCA ", \"format\": \"votca\""

static void test_target_read_takes_votca_in_nanometres(void **state) {
    struct target_rdf target;
    // A bin about 0 is half a bin, and what is not flagged i is not measured.
    assert_ok(read(state, "0 0 i\n0.1 0 i\n0.2 0.5 i\n0.3 1.5 i\n0.4 1 i\n0.5 1 i\n0.6 9 o\n",
                   VOTCA ", \"cutoff\": 0.8", &target));
    assert_int_equal(target.bins.count, 4);
    assert_close(target.bins.low, 0.1, 1e-15);
    assert_close(target.bins.width, 0.2, 1e-15);
    assert_identical(target.g[2], 1.5);
    assert_true(target.assumed);
    mf_target_rdf_clear(&target);
    // Which resampling may have left a little off 0, as in VOTCA's propane.
    assert_ok(read(state, "0 1e-7 i\n0.1 0 i\n0.2 0.5 i\n0.3 1.5 i\n0.4 1 i\n0.5 1 i\n",
                   VOTCA ", \"cutoff\": 0.8", &target));
    mf_target_rdf_clear(&target);
    assert_ok(read(state, "0 -1e-7 i\n0.1 0 i\n0.2 0.5 i\n0.3 1.5 i\n0.4 1 i\n0.5 1 i\n",
                   VOTCA ", \"cutoff\": 0.8", &target));
    assert_int_equal(target.bins.count, 4);
    mf_target_rdf_clear(&target);
    assert_refused(state, "0 -0.5 i\n0.1 0 i\n0.2 0.5 i\n0.3 1.5 i\n0.4 1 i\n0.5 1 i\n", VOTCA,
                   "g.tsv:1: a negative g, -0.5");
}

/// Normalised by N_a² for pairs of one type, of the system that was measured.
static void test_target_convert_takes_votca_to_possible_pairs(void **state) {
    static const struct box square = {2, {10, 10, 1}};
    static const struct composition one = {.types = 1, .count = {11}},
                                    binary = {.types = 2, .count = {20, 80}};
    static const struct finite_size_fluid one_fluid = {.box = &square, .composition = &one},
                                          binary_fluid = {.box = &square, .composition = &binary};
    static const char table[] = "0.1 0 i\n0.2 0.5 i\n0.3 1.5 i\n0.4 1 i\n0.5 1 i\n";
    struct target_rdf target;
    double g[5], error[5];
    assert_ok(read(state, table, VOTCA, &target));
    mf_target_rdf_convert(&target, &one_fluid, 0, g, error);
    assert_close(g[2], 1.65, 1e-15);
    mf_target_rdf_convert(&target, &binary_fluid, 0, g, error);
    assert_close(g[2], 1.5 * 20 / 19, 1e-15);
    mf_target_rdf_convert(&target, &binary_fluid, 1, g, error);
    assert_close(g[2], 1.5, 0);
    mf_target_rdf_clear(&target);
    // Of an incompressible liquid, the tail of a g that is normalised by N² knows no N.
    assert_ok(read(state, table, VOTCA ", \"particles\": 1000", &target));
    mf_target_rdf_convert(&target, &one_fluid, 0, g, error);
    assert_close(g[2], 1.65, 1e-14);
    // 200 A of 1000: measured 1 − 1/200 below the possible pairs.
    mf_target_rdf_convert(&target, &binary_fluid, 0, g, error);
    assert_close(g[2], 1.5 * 200 / 199 * (1 - 1e-3) / (1 - 1e-2), 1e-14);
    mf_target_rdf_convert(&target, &binary_fluid, 1, g, error);
    assert_close(g[2], 1.5 * (1 - 1e-3) / (1 - 1e-2), 1e-14);
    mf_target_rdf_clear(&target);
}

static void test_target_read_refuses_what_votca_does_not_write(void **state) {
    assert_refused(state, "0.1 0 i\n0.2 0.5 o\n0.3 1.5 i\n0.4 1 i\n", VOTCA, "g.tsv:2: flagged o");
    assert_refused(state, "0.1 0 i\n0.3 0.5 i\n0.2 1.5 i\n0.4 1 i\n", VOTCA,
                   "g.tsv:3: column 1 does not increase");
    assert_refused(state, "0.1 0 0\n0.2 0.5 0\n0.3 1.5 0\n0.4 1 0\n", VOTCA,
                   "g.tsv:1: expected a flag i, o or u of VOTCA");
    assert_refused(state, "0.1 0 i\n0.2 0 i\n0.3 -1.5 i\n0.4 1 i\n", VOTCA, "g.tsv:3: a negative");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_target_read_takes_votca_in_nanometres),
        TEST(test_target_convert_takes_votca_to_possible_pairs),
        TEST(test_target_read_refuses_what_votca_does_not_write),
        TEST(test_target_read_takes_the_bins_from_their_centres),
        TEST(test_target_read_takes_what_the_table_says_of_its_errors),
        TEST(test_target_read_keeps_the_whole_beside_what_is_cut),
        TEST(test_target_read_lets_the_first_bin_begin_above_0),
        TEST(test_target_read_takes_g_of_fix_ave_time),
        TEST(test_target_read_forgives_the_rounding_of_the_file),
        TEST(test_target_read_takes_the_columns_it_is_told),
        TEST(test_target_read_names_the_line_behind_a_gap),
        TEST(test_target_read_takes_a_g_slightly_below_0_as_0),
        TEST(test_target_read_refuses_what_is_no_g_of_r),
        TEST(test_target_read_leaves_the_empty_half_bin_out),
        TEST(test_target_read_takes_comma_separated_columns_with_names),
        TEST(test_target_read_refuses_errors_that_are_none),
        TEST(test_target_read_joins_rows_to_the_width_that_is_asked_for),
        TEST(test_target_read_joins_rows_by_itself_when_there_are_too_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
