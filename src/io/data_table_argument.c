// SPDX-License-Identifier: GPL-3.0-or-later
//
// The argument of a table, such as r, which increases from row to row; and what a table is whose
// argument does not.
#include "io/data_table.h"

#include <math.h>

static double cell(const struct data_table *table, size_t row, size_t column) {
    return table->values[row * table->columns + column];
}

/// A few long rows, the first of which is an argument.
static bool is_transposed(const struct data_table *table) {
    enum { MAX_ROWS = 4, MIN_COLUMNS = 10 };
    bool increases = table->rows <= MAX_ROWS && table->columns >= MIN_COLUMNS;
    for (size_t column = 1; increases && column < table->columns; column++)
        increases = cell(table, 0, column) > cell(table, 0, column - 1);
    return increases;
}

/// Two whole numbers for each that has decimals.
static bool has_halves(const struct data_table *table) {
    enum { MIN_COLUMNS = 4 };
    bool whole =
        table->separator == ',' && table->columns >= MIN_COLUMNS && table->columns % 2 == 0;
    for (size_t k = 0; whole && k < table->rows * table->columns; k++)
        whole = table->values[k] == floor(table->values[k]);
    return whole;
}

/// In line `row`, which does not increase.
static enum status fail(const struct data_table *table, const char *file, size_t column,
                        size_t row) {
    if (has_halves(table))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s:%zu: commas part columns, and begin decimals, too: \"0,5,1,02\" "
                              "is four columns; part them by semicolons or tabs, or write decimals "
                              "with a point",
                              file, table->line[0]);
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s:%zu: column %zu: %.15g does not increase from %.15g in line "
                          "%zu (are the columns in another order?)",
                          file, table->line[row], column + 1, cell(table, row, column),
                          cell(table, row - 1, column), table->line[row - 1]);
}

enum status mf_data_table_check_increasing(const struct data_table *table, const char *file,
                                           size_t column, double min) {
    if (is_transposed(table))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: %zu rows of %zu columns, the first of which increases: rows and "
                              "columns are exchanged; write a row for each value of it",
                              file, table->rows, table->columns);
    if (column >= table->columns)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no column %zu", file, column + 1);
    if (!(cell(table, 0, column) >= min))
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu: %.15g is below %.15g", file,
                              table->line[0], column + 1, cell(table, 0, column), min);
    for (size_t row = 1; row < table->rows; row++)
        if (!(cell(table, row, column) > cell(table, row - 1, column)))
            return fail(table, file, column, row);
    return STATUS_OK;
}
