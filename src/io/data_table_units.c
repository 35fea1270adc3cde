// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"
#include "io/units_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAME_SIZE = 256 };
static const char gaps[] = " \t,;";

/// After a "[…]", whatever stands in it.
static const char *after_brackets(const char *open) {
    const char *close = strchr(open, ']');
    return close ? close + 1 : open + strlen(open);
}

/// Step over a word of the line of names, and over "[nm]" in it or after it.
static const char *after_word(const char *word) {
    for (word += strcspn(word, " \t,;["); *word == '['; word += strcspn(word, " \t,;["))
        word = after_brackets(word);
    const char *next = word + strspn(word, " \t");
    return *next == '[' ? after_brackets(next) : word;
}

/// The first name of a column: a "columns:" before it is none.
static const char *first_name(const struct data_table *table) {
    const char *word = table->header + strspn(table->header, gaps), *end = after_word(word);
    return end > word && end[-1] == ':' ? end + strspn(end, gaps) : word;
}

/// The unit of a column by the line of names; false if that has none, or is of other columns.
static bool heading_unit(const struct data_table *table, size_t column, char unit[NAME_SIZE]) {
    const char *word = first_name(table), *found = NULL;
    size_t words = 0, length = 0;
    while (*word) {
        const char *end = after_word(word);
        if (words++ == column) {
            snprintf(unit, NAME_SIZE, "%.*s", (int)(end - word), word);
            found = mf_units_text_in_brackets(unit, &length);
        }
        word = end + strspn(end, gaps);
    }
    if (words != table->columns || found == NULL)
        return false;
    memmove(unit, found, length);
    unit[length] = '\0';
    return true;
}

/// The unit of the first column by the label of an axis as xmgrace has it, `@ xaxis label "r
/// (nm)"`: files of GROMACS. What is below the y axis may be many things.
static bool axis_unit(const struct data_table *table, size_t column, char unit[NAME_SIZE]) {
    for (const char *line = table->comments; column == 0 && line && *line;) {
        const char *const end = line + strcspn(line, "\n");
        char words[NAME_SIZE];
        snprintf(words, sizeof words, "%.*s", (int)(end - line), line);
        const char *const open = strrchr(words, '('), *const close =
                                                          open ? strchr(open, ')') : NULL;
        line = *end ? end + 1 : end;
        if (words[0] != '@' || !strstr(words, "xaxis") || !strstr(words, "label") || close == NULL)
            continue;
        snprintf(unit, NAME_SIZE, "%.*s", (int)(close - open - 1), open + 1);
        return true;
    }
    return false;
}

/// The unit of a column as the file tells it.
static bool find_unit(const struct data_table *table, size_t column, char unit[NAME_SIZE]) {
    return heading_unit(table, column, unit) || axis_unit(table, column, unit);
}

bool mf_data_table_unit(const struct data_table *table, size_t column, char unit[DATA_UNIT_SIZE]) {
    char given[NAME_SIZE];
    if (!heading_unit(table, column, given))
        return false;
    snprintf(unit, DATA_UNIT_SIZE, "%.*s", DATA_UNIT_SIZE - 1, given);
    return true;
}

/// A reduced file takes numbers as they are. Of a heading in other units, whose 1 is not the
/// scene's, it would make something else.
static enum status check_reduced(const struct data_table *table, const char *file, size_t column,
                                 const char *unit, const struct units *units) {
    static const double rounding = 1e-3; // of a scale that a person has written
    char given[NAME_SIZE];
    double factor;
    if (units == NULL || !mf_units_known(units) || !find_unit(table, column, given) ||
        mf_units_from(units, given, unit, &factor) != STATUS_OK || fabs(factor - 1) < rounding)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: column %zu is in %.60s, and the file that names it is reduced, with "
                          "%g %.60s for 1 by its \"units\"; a file in \"nm-ps\" or \"angstrom-fs\" "
                          "converts tables",
                          file, column + 1, given, 1 / factor, given);
}

enum status mf_data_table_convert(struct data_table *table, const char *file, size_t column,
                                  const char *unit, const struct units *units) {
    char given[NAME_SIZE];
    double factor = 1;
    if (!mf_units_are_physical(units))
        return check_reduced(table, file, column, unit, units);
    const bool named = find_unit(table, column, given);
    const enum status status = named ? mf_units_from(units, given, unit, &factor) : STATUS_OK;
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s: column %zu", file, column + 1);
    const double physical = mf_units_factor(units, unit);
    for (size_t row = 0; row < table->rows; row++) {
        double *value = &table->values[row * table->columns + column];
        // As numbers of the file itself are converted, to the same bits.
        const double reduced = named ? *value * factor : *value / physical;
        if (isinf(reduced))
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu: %g is too large", file,
                                  table->line[row], column + 1, *value);
        *value = reduced;
    }
    return STATUS_OK;
}

/// Formats with a fixed number of decimals are for one unit.
static const char *format_of(const struct data_column *column) {
    const size_t length = column->format ? strlen(column->format) : 0;
    return length > 0 && column->format[length - 1] == 'f' ? NULL : column->format;
}

double mf_data_table_translate(const struct units *units, const char *heading, char *name,
                               size_t size) {
    char unit[UNITS_NAME_SIZE], physical[UNITS_NAME_SIZE];
    size_t length;
    const char *found = mf_units_text_in_brackets(heading, &length);
    snprintf(name, size, "%s", heading);
    if (!mf_units_are_physical(units) || found == NULL || length >= sizeof unit)
        return 1;
    snprintf(unit, sizeof unit, "%.*s", (int)length, found);
    const double factor = mf_units_factor(units, unit);
    snprintf(name, size, "%.*s%s]", (int)(found - heading), heading,
             mf_units_name(units, unit, physical));
    return factor;
}

void mf_data_table_name(const struct units *units, const char *name, const char *unit,
                        char *heading, size_t size) {
    if (!mf_units_are_physical(units))
        snprintf(heading, size, "%s", name);
    else
        snprintf(heading, size, "%s[%s]", name, unit);
}

/// Columns that are written, and the room for those that are converted.
struct columns {
    struct data_column *column;
    char (*name)[NAME_SIZE];
    double *values; ///< shape [columns, rows]
    size_t count, rows;
};

/// Nobody reads it back.
static double multiply(double reduced, double factor) {
    return factor * reduced;
}

/// Add a column in the units that `units` speak.
static void add_column(struct columns *columns, const struct units *units,
                       const struct data_column *from, const char *format,
                       double (*convert)(double, double)) {
    double *const values = columns->values + columns->count * columns->rows;
    char *const name = columns->name[columns->count];
    struct data_column *const to = &columns->column[columns->count++];
    const double factor = mf_data_table_translate(units, from->name, name, NAME_SIZE);
    *to = (struct data_column){name, from->values, from->format};
    if (factor == 1)
        return;
    for (size_t k = 0; k < columns->rows; k++)
        values[k] = convert(from->values[k], factor);
    to->values = values;
    to->format = format;
}

static enum status write_all(const char *file, const struct units *units, const char *comment,
                             const struct data_column *column, const char *const *beside,
                             size_t count, size_t rows) {
    enum status status = STATUS_OK;
    struct units physical = *units;
    struct columns all = {.rows = rows};
    physical.system = UNITS_NM_PS;
    NEW_ARRAY(all.column, 2 * count);
    NEW_ARRAY(all.name, 2 * count);
    NEW_ARRAY(all.values, 2 * count * rows + 1);
    for (size_t c = 0; c < count; c++)
        add_column(&all, units, &column[c], format_of(&column[c]), mf_units_file_value);
    for (size_t c = 0; beside && c < count; c++) {
        const struct data_column again = {column[c].name, column[c].values, beside[c]};
        if (beside[c])
            add_column(&all, &physical, &again, beside[c], multiply);
    }
    status = mf_data_table_write(file, comment, all.column, all.count, rows);
done:
    mf_memory_free(all.column);
    mf_memory_free(all.name);
    mf_memory_free(all.values);
    return status;
}

static void write_comment(FILE *stream, const char *comment) {
    struct data_line line = mf_data_line_first(comment);
    do
        fprintf(stream, "# %.*s\n", (int)(line.end - line.begin), line.begin);
    while (mf_data_line_next(&line) && *line.begin);
}

static void write_header(FILE *stream, const struct data_column *columns, size_t count) {
    fputs("# ", stream);
    for (size_t column = 0; column < count; column++)
        fprintf(stream, "%s%s", column ? "\t" : "", columns[column].name);
    fputc('\n', stream);
}

static void write_row(FILE *stream, const struct data_column *columns, size_t count, size_t row) {
    for (size_t column = 0; column < count; column++) {
        const char *format = columns[column].format ? columns[column].format : "%.10g";
        const double value = columns[column].values[row];
        if (column > 0)
            fputc('\t', stream);
        if (isnan(value))
            fputs("nan", stream); // printf would add the sign that a NaN happens to carry
        else
            fprintf(stream, format, value);
    }
    fputc('\n', stream);
}

enum status mf_data_table_write(const char *file, const char *comment,
                                const struct data_column *columns, size_t column_count,
                                size_t rows) {
    struct output output;
    TRY(mf_output_open(&output, file));
    if (comment)
        write_comment(output.stream, comment);
    write_header(output.stream, columns, column_count);
    for (size_t row = 0; row < rows; row++)
        write_row(output.stream, columns, column_count, row);
    return mf_output_commit(&output);
}

enum status mf_data_table_write_in(const char *file, const struct units *units, const char *comment,
                                   const struct data_column *columns, size_t column_count,
                                   size_t rows) {
    return mf_units_are_physical(units)
               ? write_all(file, units, comment, columns, NULL, column_count, rows)
               : mf_data_table_write(file, comment, columns, column_count, rows);
}

enum status mf_data_table_write_beside(const char *file, const struct units *units,
                                       const char *comment, const struct data_column *columns,
                                       const char *const *beside, size_t column_count,
                                       size_t rows) {
    return write_all(file, units, comment, columns,
                     mf_units_have_second_columns(units) ? beside : NULL, column_count, rows);
}

//
// The argument of a table, such as r, which increases from row to row; and what a table is whose
// argument does not.

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
