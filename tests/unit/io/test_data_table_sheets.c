// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tables as spreadsheets, digitising programs and people write them: 26 ways are read as what they
// say, the others are refused with a remedy.
#include "io/data_table.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ROWS = 40, TEXT = 8192 };

static double r_of(int k) {
    return 2.45 + 0.1 * k;
}

static double g_of(int k) {
    return k < 3 ? 0 : 1 + 0.5 * sin(0.4 * k);
}

/// How a table is written: before it, a row with %s for both numbers, after it.
struct sheet {
    const char *name, *before, *row, *after;
    char decimal;
    double unit;         ///< of r in the file's numbers, if they are not Å
    const char *refusal; ///< NULL: it is read
};

static const struct sheet sheets[] = {
    {"tabs", "# r\tg\n", "%s\t%s\n", "", '.', 0, NULL},
    {"blanks", "", "   %s  %s\n", "", '.', 0, NULL},
    {"commas", "r,g\n", "%s,%s\n", "", '.', 0, NULL},
    {"commas and blanks", "r, g\n", "%s, %s\n", "", '.', 0, NULL},
    {"semicolons", "r;g\n", "%s;%s\n", "", '.', 0, NULL},
    {"decimal commas, semicolons", "r;g\n", "%s;%s\n", "", ',', 0, NULL},
    {"decimal commas, tabs", "r\tg\n", "%s\t%s\n", "", ',', 0, NULL},
    {"decimal commas, quoted", "\"r\",\"g\"\n", "\"%s\",\"%s\"\n", "", ',', 0, NULL},
    {"quoted", "\"r\",\"g\"\n", "\"%s\",\"%s\"\n", "", '.', 0, NULL},
    {"no header", "", "%s,%s\n", "", '.', 0, NULL},
    {"lines of Windows", "r,g\r\n", "%s,%s\r\n", "", '.', 0, NULL},
    {"lines of old Macs", "r,g\r", "%s,%s\r", "", '.', 0, NULL},
    {"byte order mark", "\xef\xbb\xbfr,g\n", "%s,%s\n", "", '.', 0, NULL},
    {"two header lines", "Liquid argon, 85 K\nr,g\n", "%s,%s\n", "", '.', 0, NULL},
    {"title and blank line", "\"Liquid argon, Fig. 2\",\n\nr,g\n", "%s,%s\n", "", '.', 0, NULL},
    {"row of units", "r,g\nA,-\n", "%s,%s\n", "", '.', 0, NULL},
    {"row of units, nm", "r,g\nnm,1\n", "%s,%s\n", "", '.', 0.1, NULL},
    {"r (nm)", "r (nm),g(r)\n", "%s,%s\n", "", '.', 0.1, NULL},
    {"r [nm]", "r [nm],g\n", "%s,%s\n", "", '.', 0.1, NULL},
    {"labels first", "name,r,g\n", "argon,%s,%s\n", "", '.', 0, NULL},
    {"labels last", "r,g,who\n", "%s,%s,me\n", "", '.', 0, NULL},
    {"empty columns at the end", "r,g,,\n", "%s,%s,,\n", "", '.', 0, NULL},
    {"an empty column at the end", "r;g;\n", "%s;%s;\n", "", ',', 0, NULL},
    {"errors", "r,g,error\n", "%s,%s,0.01\n", "", '.', 0, NULL},
    {"empty lines", "r,g\n\n", "%s,%s\n\n", "", '.', 0, NULL},
    {"lines with %", "% digitised\n% r,g\n", "%s,%s\n", "", '.', 0, NULL},
    {"UTF-16", "\xff\xfer", "%s", "", '.', 0, "save the spreadsheet as CSV (UTF-8)"},
    {"zip", "PK\3\4", "%s", "", '.', 0, "save the spreadsheet as CSV (UTF-8)"},
    {"empty cell", "r,g\n", "%s,%s\n", "9.9,\n", '.', 0, "a cell is empty; leave out its row"},
    {"#N/A", "r,g\n", "%s,%s\n", "9.9,#N/A\n", '.', 0, "begin lines of text with #"},
    {"footnote", "r,g\n", "%s,%s\n", "Source: a book\n", '.', 0, "begin lines of text with #"},
    {"the minus of printers", "r,g\n", "%s,%s\n", "9.9,\xe2\x88\x92\x31\n", '.', 0,
     "begin lines of text with #"},
    {"one column", "r\n", "%s\n", "", '.', 0, "1 columns, at least 2 are needed"},
};

static void print_number(double value, char decimal, char text[32]) {
    snprintf(text, 32, "%.5f", value);
    *strchr(text, '.') = decimal;
}

static size_t print_sheet(const struct sheet *sheet, char text[TEXT]) {
    size_t length = (size_t)snprintf(text, TEXT, "%s", sheet->before);
    for (int k = 0; k < ROWS; k++) {
        char r[32], g[32];
        print_number((sheet->unit > 0 ? sheet->unit : 1) * r_of(k), sheet->decimal, r);
        print_number(g_of(k), sheet->decimal, g);
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        length += (size_t)snprintf(text + length, TEXT - length, sheet->row, r, g);
#pragma GCC diagnostic pop
    }
    length += (size_t)snprintf(text + length, TEXT - length, "%s", sheet->after);
    if (strcmp(sheet->name, "UTF-16") == 0 || strcmp(sheet->name, "zip") == 0)
        text[length++] = '\0';
    assert_true(length < TEXT);
    return length;
}

static void assert_numbers(const struct sheet *sheet, struct data_table *table, const char *file) {
    const struct units angstrom = {
        .length = 1, .temperature = 300, .mass = 1, .system = UNITS_ANGSTROM_FS};
    if (table->rows != ROWS)
        fail_msg("%s: %zu rows", sheet->name, table->rows);
    assert_ok(mf_data_table_convert(table, file, 0, "lambda", &angstrom));
    const double scale = mf_units_factor(&angstrom, "lambda");
    for (int k = 0; k < ROWS; k++) {
        const double *const row = &table->values[(size_t)k * table->columns];
        if (!(fabs(scale * row[0] - r_of(k)) < 2e-4 && fabs(row[1] - g_of(k)) < 1e-5))
            fail_msg("%s: row %d: %g %g", sheet->name, k, row[0], row[1]);
    }
}

static void test_sheets_are_read_or_refused_with_a_remedy(void **state) {
    static char text[TEXT];
    size_t read = 0;
    for (size_t n = 0; n < sizeof sheets / sizeof *sheets; n++) {
        const struct sheet *const sheet = &sheets[n];
        struct data_table table;
        const size_t length = print_sheet(sheet, text);
        const char *const file = temporary_folder_write(*state, "t.csv", text, length);
        const enum status status = mf_data_table_read(&table, file, 2);
        if (sheet->refusal) {
            assert_int_equal(status, STATUS_BAD_INPUT);
            assert_contains(mf_status_message(), sheet->refusal);
            continue;
        }
        if (status != STATUS_OK)
            fail_msg("%s: %s", sheet->name, mf_status_message());
        assert_numbers(sheet, &table, file);
        mf_data_table_clear(&table);
        read++;
    }
    assert_int_equal(read, 26);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_sheets_are_read_or_refused_with_a_remedy,
                                        temporary_folder_create, temporary_folder_remove)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
