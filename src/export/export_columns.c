// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_columns.h"

#include "base/memory.h"
#include "io/data_table.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// The place of the column called `name` in a heading, and the unit after it; −1: none.
static long find_column(const char *header, const char *name, char *unit, size_t size) {
    const size_t length = strlen(name);
    const char *word = header + strspn(header, " \t");
    for (long place = 0; *word; place++) {
        const size_t end = strcspn(word, "\t\r\n");
        if (strncmp(word, name, length) == 0 && (word[length] == '[' || length == end)) {
            const char *open = word + length + (word[length] == '[');
            snprintf(unit, size, "%.*s", (int)(strcspn(open, "]\t\r\n")), open);
            return place;
        }
        word += end;
        word += strspn(word, "\t\r\n");
    }
    return -1;
}

/// One column into `values`, shape [rows].
static enum status take_column(const struct data_table *table, const char *file,
                               const struct units *units, const struct export_column *column,
                               double *values) {
    char unit[UNITS_NAME_SIZE] = "";
    double factor = 1;
    const long place = find_column(table->header, column->name, unit, sizeof unit);
    if (place < 0 && column->required)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: no column called %s", file, column->name);
    if (place >= 0 && strcmp(unit, column->unit) != 0) {
        if (!mf_units_known(units))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: %s is in \"%s\", but used.json has no units", file,
                                  column->name, unit);
        if (mf_units_from(units, unit, column->unit, &factor) != STATUS_OK)
            return mf_status_prefix(STATUS_BAD_INPUT, "%s: %s", file, column->name);
    }
    for (size_t k = 0; k < table->rows; k++)
        values[k] = place < 0 ? NAN : factor * table->values[k * table->columns + (size_t)place];
    return STATUS_OK;
}

enum status mf_export_columns_read(struct export_columns *columns, const char *file,
                                   const struct units *units, const struct export_column *wanted) {
    enum status status = STATUS_OK;
    struct data_table table = {0};
    size_t count = 0, required = 0;
    *columns = (struct export_columns){0};
    for (; wanted[count].name; count++)
        required += wanted[count].required;
    CHECK(mf_data_table_read(&table, file, required));
    columns->rows = table.rows;
    NEW_ARRAY(columns->values, count * table.rows);
    for (size_t c = 0; c < count; c++)
        CHECK(take_column(&table, file, units, &wanted[c], columns->values + c * table.rows));
done:
    mf_data_table_clear(&table);
    if (status != STATUS_OK)
        mf_export_columns_clear(columns);
    return status;
}

void mf_export_columns_clear(struct export_columns *columns) {
    mf_memory_free(columns->values);
    *columns = (struct export_columns){0};
}
