// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <unistd.h>

#include <math.h>
#include <stdlib.h>

static const char *write_text(void **state, const char *text) {
    return temporary_folder_write(*state, "t.dat", text, strlen(text));
}

static void assert_refused(void **state, const char *text, const char *part) {
    struct data_table table;
    assert_fails(mf_data_table_read(&table, write_text(state, text), 2), STATUS_BAD_INPUT, part);
    assert_null(table.values);
}

static void test_data_table_read_finds_rows_when_comments_and_blanks_surround_them(void **state) {
    struct data_table table;
    const char *text = "@ title \"rdf\"\n"
                       "#\tr[nm]  g \n"
                       "\n"
                       "  0.5\t1e-3  \n"
                       "# between\n"
                       "\t1.5 -2.5E+2\n"
                       "   \n"
                       "2.5 .5";
    assert_ok(mf_data_table_read(&table, write_text(state, text), 2));
    assert_int_equal(table.rows, 3);
    assert_int_equal(table.columns, 2);
    const double expected[] = {0.5, 1e-3, 1.5, -250, 2.5, 0.5};
    for (int k = 0; k < 6; k++)
        assert_identical(table.values[k], expected[k]);
    assert_int_equal(table.line[0], 4);
    assert_int_equal(table.line[1], 6);
    assert_int_equal(table.line[2], 8);
    assert_string_equal(table.header, "r[nm]  g");
    assert_string_equal(table.comments, "@ title \"rdf\"\n#\tr[nm]  g\n");
    mf_data_table_clear(&table);
    assert_null(table.values);
}

static void assert_lines(void **state, const char *text) {
    struct data_table table;
    assert_ok(mf_data_table_read(&table, write_text(state, text), 2));
    assert_int_equal(table.rows, 2);
    assert_int_equal(table.columns, 2);
    assert_identical(table.values[3], 4.0);
    assert_int_equal(table.line[1], 4);
    assert_string_equal(table.header, "r g");
    assert_string_equal(table.comments, "# r g\n");
    mf_data_table_clear(&table);
}

static void test_data_table_read_takes_line_ends_of_other_systems(void **state) {
    assert_lines(state, "\xEF\xBB\xBF# r g\r\n1 2\r\n\r\n3 4\r\n");
    assert_lines(state, "# r g\r1 2\r\r3 4\r");
    assert_lines(state, "# r g\r1 2\n\r3 4"); // whatever made it
}

static void test_data_table_read_takes_a_line_of_names_for_the_header(void **state) {
    struct data_table table;
    assert_ok(mf_data_table_read(&table, write_text(state, "# a run\nx y mass\n1 2 3\n"), 3));
    assert_string_equal(table.header, "x y mass");
    assert_string_equal(table.comments, "# a run\n");
    assert_int_equal(table.rows, 1);
    mf_data_table_clear(&table);
}

static void test_data_table_read_has_an_empty_header_when_there_is_no_comment(void **state) {
    struct data_table table;
    assert_ok(mf_data_table_read(&table, write_text(state, "1\n# late\n2\n"), 1));
    assert_string_equal(table.header, "");
    assert_string_equal(table.comments, "");
    assert_int_equal(table.rows, 2);
    mf_data_table_clear(&table);
}

/// Read `text`, which must hold the rows 0.5 1.5 0.1 and 1 2 0.2, the first in line `first`.
static void assert_same_rows(void **state, const char *text, size_t first) {
    static const double expected[] = {0.5, 1.5, 0.1, 1, 2, 0.2};
    struct data_table table;
    assert_ok(mf_data_table_read(&table, write_text(state, text), 3));
    assert_int_equal(table.rows, 2);
    assert_int_equal(table.columns, 3);
    assert_memory_equal(table.values, expected, sizeof expected);
    assert_int_equal(table.line[0], first);
    mf_data_table_clear(&table);
}

static void
test_data_table_read_takes_commas_and_semicolons_when_the_first_row_has_them(void **state) {
    assert_same_rows(state, "0.5,1.5,0.1\n1,2,0.2\n", 1);
    assert_same_rows(state, "0.5 , 1.5,\t0.1 \r\n 1,2 ,0.2,\r\n", 1);
    assert_same_rows(state, "0.5;1.5;0.1\n1 ; 2; 0.2;\n", 1);
    assert_refused(state, "0.5,,0.1\n", ":1: column 2: \"\" is not a finite number");
    assert_refused(state, "1,2,3\n4 5 6\n", ":2: column 1: \"4 5 6\"");
}

static void test_data_table_read_skips_names_of_columns_and_percent_comments(void **state) {
    assert_same_rows(state, "r,g,err\n0.5,1.5,0.1\n1,2,0.2\n", 2);
    assert_same_rows(state, "\"r\";\"g\";\"err\"\n0.5;1.5;0.1\n1;2;0.2\n", 2);
    assert_same_rows(state, "% made by hand\nr g err\n0.5 1.5 0.1\n% more\n1 2 0.2\n", 3);
    assert_refused(state, "1 2\nr g\n",
                   ":2: column 1: \"r\" is not a finite number: begin lines of text with #");
    assert_refused(state, "1 2\nr g\n1 2\n", ":2: column 1: \"r\"");
    assert_refused(state, "2 columns\n1 2\n",
                   ":1: column 2: \"columns\" is not a finite number: begin lines of text with #");
    assert_refused(state, "nan nan\n1 2\n", ":1: column 1: \"nan\"");
    assert_refused(state, "r g\n", ":2: the file ends without a row of numbers");
}

/// As Baydin's potentials begin, which no particle enters.
static void test_data_table_read_core_leaves_out_what_is_infinite_at_the_begin(void **state) {
    struct data_table table;
    const double expected[] = {0.5, 5, 0.7, 2};
    assert_ok(mf_data_table_read_core(&table,
                                      write_text(state, "0.1 Infinity\n0.3 inf\n0.5 5\n0.7 2\n")));
    assert_int_equal(table.rows, 2);
    assert_memory_equal(table.values, expected, sizeof expected);
    assert_int_equal(table.line[0], 3);
    mf_data_table_clear(&table);
    assert_fails(mf_data_table_read_core(&table, write_text(state, "0.5 5\n0.7 inf\n0.9 1\n")),
                 STATUS_BAD_INPUT, ":2: an infinite value behind finite ones");
    mf_data_table_clear(&table);
    assert_fails(mf_data_table_read_core(&table, write_text(state, "inf 5\n0.7 1\n")),
                 STATUS_BAD_INPUT, "\"inf\"");
    mf_data_table_clear(&table);
    assert_refused(state, "0.1 inf\n0.3 1\n", "\"inf\" is not a finite number");
}

static void test_data_table_read_takes_the_first_set_when_a_line_ends_it(void **state) {
    assert_same_rows(state, "@TYPE xy\n0.5 1.5 0.1\n1 2 0.2\n&\n", 2);
    assert_same_rows(state, "@TYPE xy\n0.5 1.5 0.1\n1 2 0.2\n&\n@TYPE xy\n0.5 x\n&\n", 2);
}

static void assert_r_and_values(void **state, const char *text, bool averaged, size_t first_line) {
    struct data_table table;
    assert_ok(mf_data_table_read(&table, write_text(state, text), 2));
    assert_int_equal(table.rows, 3);
    assert_int_equal(table.columns, 3);
    const double expected[] = {0.5, 8, -1, 1.5, 4, -2, 2.5, 2, -3};
    for (int k = 0; k < 9; k++)
        assert_identical(table.values[k], expected[k]);
    assert_int_equal(table.line[0], first_line);
    assert_int_equal(table.lammps, averaged ? DATA_LAMMPS_AVERAGE : DATA_LAMMPS_LAW);
    mf_data_table_clear(&table);
}

/// Manual of LAMMPS: pair_style table, fix ave/time.
static void test_data_table_read_leaves_out_the_numbers_of_rows_of_lammps(void **state) {
    struct data_table table;
    assert_r_and_values(state,
                        "# DATE: 2020-06-10\n\nSOME_WORD\nN 3 FP 1 2\n\n 1 0.5 8 -1\n 2 1.5 4 -2\n"
                        "# between\n 3 2.5 2 -3\n",
                        false, 6);
    assert_r_and_values(state,
                        "# Time-averaged data for fix r\n# TimeStep Number-of-rows\n# Row a b c\n"
                        "60000 3\n1 0.5 8 -1\n2 1.5 4 -2\n3 2.5 2 -3\n",
                        true, 5);
    assert_refused(state, "0 3\n1 0.5 8\n2 1 4\n3 2 2\n100 3\n1 0.5 8\n2 1 4\n3 2 2\n",
                   "t.dat:5: a second section of LAMMPS begins");
    // What only looks like it stays, and is refused as ever.
    assert_refused(state, "7 4\n1 0.5 8\n2 1 4\n3 2 2\n", "the first row has 2");
    assert_refused(state, "7 3\n1 0.5 8\n2 1 4\n4 2 2\n", "the first row has 2");
    assert_ok(mf_data_table_read(&table, write_text(state, "1 2\n2 4\n"), 2));
    assert_int_equal(table.rows, 2);
    mf_data_table_clear(&table);
}

static void test_data_table_read_says_so_when_decimals_have_a_comma(void **state) {
    assert_refused(state, "0.5;1.5\n1;1,25\n",
                   ":2: column 2: \"1,25\" is not a finite number: a decimal comma? other");
    assert_refused(state, "0,5;1,5\n1;1.25\n",
                   ":2: column 2: \"1.25\" is not a finite number: other decimals of the file");
    assert_refused(state, "0,5 1,5\n",
                   ":1: column 1: \"0,5\" is not a finite number: a decimal comma? separate "
                   "columns by semicolons or tabs, or write decimals with a point");
    assert_refused(state, "1.000,5;2\n", ":1: column 1: \"1.000,5\"");
}

static void test_data_table_read_takes_decimal_commas_that_part_no_columns(void **state) {
    assert_same_rows(state, "0,5;1,5;0,1\n1;2;0,2\n", 1);
    assert_same_rows(state, "0,5\t1,5\t1e-1\n1\t2\t0,2\n", 1);
    assert_same_rows(state, "\"0,5\",\"1,5\",\"0,1\"\n\"1\",\"2\",\"0,2\"\n", 1);
}

/// As spreadsheets and people write them.
static void test_data_table_read_takes_lines_of_text_and_words_in_quotes(void **state) {
    assert_same_rows(state,
                     "Digitised from Fig. 2, argon at 85 K;\n\"r; first\";\"g\";\"err\"\n"
                     "0.5;1.5;0.1\n1;2;0.2\n",
                     3);
    assert_same_rows(state, "\"r (nm)\",\"g, all\",\"err\"\n\"0.5\",\"1.5\",0.1\n1,2,\"0.2\"\n", 2);
    assert_same_rows(state, "the g of argon\nr g err\nnm - -\n0.5 1.5 0.1\n1 2 0.2\n", 4);
}

/// Columns of text are not counted; the flags of VOTCA are no text, for they say what is measured.
static void test_data_table_read_leaves_columns_of_text_out(void **state) {
    struct data_table table;
    assert_same_rows(state, "Ar-Ar 0.5 1.5 0.1\nAr-Kr 1 2 0.2\n", 1);
    assert_same_rows(state, "pair,r,g,err,by\nA,0.5,1.5,0.1,me\nB,1,2,0.2,you\n", 2);
    assert_refused(state, "1 A 2\n3 4 5\n6 C 7\n8 D 9\n",
                   ":2: column 2: 4 is a number, and the last rows have text there");
    assert_refused(state, "1 2 i\n3 4 o\n5 6 u\n", ":1: column 3: \"i\"");
    assert_ok(
        mf_data_table_read(&table, write_text(state, "pair;r (nm);g of r\nA;1;2\nB;3;4\n"), 2));
    assert_string_equal(table.header, "r[nm]\tg_of_r");
    mf_data_table_clear(&table);
}

static void test_data_table_read_takes_nan_when_it_stands_beyond_the_wanted_columns(void **state) {
    struct data_table table;
    assert_ok(mf_data_table_read(&table, write_text(state, "1 2 nan\n3 4 5\n"), 2));
    assert_true(isnan(table.values[2]));
    assert_identical(table.values[5], 5.0);
    mf_data_table_clear(&table);
    assert_refused(state, "1 2 3\n3 4 inf\n", ":2: column 3: \"inf\"");
}

static void test_data_table_read_names_the_line_when_a_word_is_not_a_finite_number(void **state) {
    assert_refused(state, "1 2\n3 abc\n", "t.dat:2: column 2: \"abc\" is not a finite number");
    assert_refused(state, "1 2\n3 nan\n", ":2: column 2: \"nan\"");
    assert_refused(state, "inf 2\n", ":1: column 1: \"inf\"");
    assert_refused(state, "1 1e999\n", ":1: column 2: \"1e999\"");
    assert_refused(state, "1 0x10\n", ":1: column 2: \"0x10\"");
    assert_refused(state, "1,5 2\n", ":1: column 1: \"1,5\"");
    assert_refused(state, "1 2-3\n", ":1: column 2: \"2-3\"");
    assert_refused(state, "1 2 # note\n", ":1: column 3: \"#\"");
}

static void test_data_table_read_names_the_line_when_a_row_has_another_length(void **state) {
    assert_refused(state, "1 2\n3 4\n5\n", "t.dat:3: 1 columns, the first row has 2");
    assert_refused(state, "1 2\n3 4 5\n", "t.dat:2: 3 columns, the first row has 2");
    assert_refused(state, "1 2 3\n1 2 3 a\n4 5 6 b\n",
                   "t.dat:1: 3 columns, and the last rows have text in column 4");
    assert_refused(state, "# r\n1\n2\n",
                   "t.dat:2: 1 columns, at least 2 are needed (blanks, commas or semi");
}

static void test_data_table_read_says_so_when_there_is_nothing_to_read(void **state) {
    struct data_table table;
    assert_refused(state, "", "t.dat: the file is empty");
    assert_refused(state, "# only\n\n", "t.dat:3: the file ends without a row of numbers");
    assert_fails(
        mf_data_table_read(&table, temporary_folder_write(*state, "t.dat", "1 2\n3 \0 4\n", 10), 2),
        STATUS_BAD_INPUT, "t.dat:2:3: a NUL byte");
    assert_fails(mf_data_table_read(&table, temporary_folder_file(*state, "none"), 2), STATUS_IO,
                 "none: No such file or directory");
    assert_fails(mf_data_table_read(&table, ((struct temporary_folder *)*state)->path, 2),
                 STATUS_IO, "is a folder, not a file");
}

/// Devices have no end, and a file of a gigabyte is no table.
static void test_data_table_read_refuses_what_has_no_end(void **state) {
    struct data_table table;
    assert_fails(mf_data_table_read(&table, "/dev/zero", 1), STATUS_IO,
                 "/dev/zero: is a device, not a file");
    assert_fails(mf_data_table_read(&table, "/dev/full", 1), STATUS_IO, "is a device");
    const char *file = temporary_folder_write(*state, "large.tsv", "1 2\n", 4);
    assert_int_equal(truncate(file, ((off_t)1 << 30) + 1), 0); // without a block on the disk
    assert_fails(mf_data_table_read(&table, file, 1), STATUS_BAD_INPUT, "larger than 1 GiB");
}

static void test_data_table_read_takes_long_files_when_they_outgrow_the_buffer(void **state) {
    struct data_table table;
    enum { ROWS = 30000 };
    double *values = calloc(ROWS, sizeof *values);
    assert_non_null(values);
    for (int k = 0; k < ROWS; k++)
        values[k] = k / 7.0;
    const struct data_column columns[] = {{"x", values, "%.17g"}};
    const char *file = temporary_folder_file(*state, "long.dat");
    assert_ok(mf_data_table_write(file, NULL, columns, 1, ROWS));
    assert_ok(mf_data_table_read(&table, file, 1));
    assert_int_equal(table.rows, ROWS);
    assert_memory_equal(table.values, values, ROWS * sizeof *values);
    mf_data_table_clear(&table);
    free(values);
}

static void test_data_table_check_increasing_names_the_line_when_a_row_does_not_grow(void **state) {
    struct data_table table;
    const char *file = write_text(state, "# r\n0 5\n1 4\n\n1 6\n");
    assert_ok(mf_data_table_read(&table, file, 2));
    assert_fails(mf_data_table_check_increasing(&table, file, 0, 0), STATUS_BAD_INPUT,
                 "t.dat:5: column 1: 1 does not increase from 1 in line 3");
    assert_fails(mf_data_table_check_increasing(&table, file, 1, 0), STATUS_BAD_INPUT,
                 "t.dat:3: column 2: 4 does not increase from 5 in line 2");
    assert_fails(mf_data_table_check_increasing(&table, file, 0, 0.5), STATUS_BAD_INPUT,
                 "t.dat:2: column 1: 0 is below 0.5");
    assert_fails(mf_data_table_check_increasing(&table, file, 2, 0), STATUS_BAD_INPUT,
                 "there is no column 3");
    table.rows = 2;
    assert_ok(mf_data_table_check_increasing(&table, file, 0, 0));
    mf_data_table_clear(&table);
}

static void test_data_table_write_prints_comment_header_and_rows_when_asked(void **state) {
    const double r[] = {0.125, 2}, g[] = {1.0 / 3, -1e-20};
    const struct data_column columns[] = {{"r[lambda]", r, "%.3f"}, {"g", g, NULL}};
    const char *file = temporary_folder_file(*state, "t.dat");
    assert_ok(mf_data_table_write(file, "made by a test\nseed 7\n", columns, 2, 2));
    char *text = temporary_folder_read(file);
    assert_string_equal(text, "# made by a test\n# seed 7\n# r[lambda]\tg\n"
                              "0.125\t0.3333333333\n2.000\t-1e-20\n");
    free(text);

    struct data_table table;
    assert_ok(mf_data_table_read(&table, file, 2));
    assert_string_equal(table.header, "r[lambda]\tg");
    mf_data_table_clear(&table);
}

static void test_data_table_write_names_the_file_when_it_cannot_be_made(void **state) {
    const struct data_column columns[] = {{"x", (double[]){1}, NULL}};
    assert_fails(
        mf_data_table_write(temporary_folder_file(*state, "no/t.dat"), NULL, columns, 1, 1),
        STATUS_IO, "no/t.dat: No such file or directory");
}

/// A comment of as many words as there are columns passes for names, another does not.
static void test_data_table_find_knows_columns_by_their_names_without_units(void **state) {
    struct data_table table;
    assert_ok(mf_data_table_read(
        &table, write_text(state, "# time[tau]\tmsd[lambda^2]\tmsd_error[lambda^2]\n0 1 2\n"), 2));
    assert_int_equal(mf_data_table_find(&table, "msd"), 2);
    assert_int_equal(mf_data_table_find(&table, "msd_error"), 3);
    assert_int_equal(mf_data_table_find(&table, "ms"), 0);
    mf_data_table_clear(&table);
    assert_ok(mf_data_table_read(&table, write_text(state, "# the msd of all\n0 1 2\n"), 2));
    assert_int_equal(mf_data_table_find(&table, "msd"), 0);
    mf_data_table_clear(&table);
}

#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_data_table_read_finds_rows_when_comments_and_blanks_surround_them),
        IN_FOLDER(test_data_table_read_takes_line_ends_of_other_systems),
        IN_FOLDER(test_data_table_read_takes_a_line_of_names_for_the_header),
        IN_FOLDER(test_data_table_read_has_an_empty_header_when_there_is_no_comment),
        IN_FOLDER(test_data_table_read_takes_nan_when_it_stands_beyond_the_wanted_columns),
        IN_FOLDER(test_data_table_read_takes_commas_and_semicolons_when_the_first_row_has_them),
        IN_FOLDER(test_data_table_read_skips_names_of_columns_and_percent_comments),
        IN_FOLDER(test_data_table_read_core_leaves_out_what_is_infinite_at_the_begin),
        IN_FOLDER(test_data_table_read_takes_the_first_set_when_a_line_ends_it),
        IN_FOLDER(test_data_table_read_leaves_out_the_numbers_of_rows_of_lammps),
        IN_FOLDER(test_data_table_read_says_so_when_decimals_have_a_comma),
        IN_FOLDER(test_data_table_read_takes_decimal_commas_that_part_no_columns),
        IN_FOLDER(test_data_table_read_takes_lines_of_text_and_words_in_quotes),
        IN_FOLDER(test_data_table_read_leaves_columns_of_text_out),
        IN_FOLDER(test_data_table_read_names_the_line_when_a_word_is_not_a_finite_number),
        IN_FOLDER(test_data_table_read_names_the_line_when_a_row_has_another_length),
        IN_FOLDER(test_data_table_read_says_so_when_there_is_nothing_to_read),
        IN_FOLDER(test_data_table_read_refuses_what_has_no_end),
        IN_FOLDER(test_data_table_read_takes_long_files_when_they_outgrow_the_buffer),
        IN_FOLDER(test_data_table_check_increasing_names_the_line_when_a_row_does_not_grow),
        IN_FOLDER(test_data_table_find_knows_columns_by_their_names_without_units),
        IN_FOLDER(test_data_table_write_prints_comment_header_and_rows_when_asked),
        IN_FOLDER(test_data_table_write_names_the_file_when_it_cannot_be_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
