// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_columns.h"

#include "base/memory.h"
#include "io/data_table.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// What a number in `unit` is to be multiplied with to be reduced; NAN: such a unit is not known.
static double to_reduced(const char *unit, const struct units *units) {
    static const char *const reduced[] = {
        "lambda", "k_B.T_0", "k_B.T_0/lambda", "sqrt(mu/tau)", "lambda/tau", "1", ""};
    for (size_t k = 0; k < sizeof reduced / sizeof *reduced; k++)
        if (strcmp(unit, reduced[k]) == 0)
            return 1;
    if (mf_units_known(units) && strcmp(unit, "nm") == 0)
        return 1 / units->length;
    if (mf_units_known(units) && strcmp(unit, "kJ/mol") == 0)
        return 1 / mf_units_energy_kj_per_mol(units);
    return NAN;
}

/// The place of the column called `name` in a heading, and the unit behind it; −1: none.
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
                               const struct units *units, const char *name, bool required,
                               double *values) {
    char unit[64] = "";
    const long place = find_column(table->header, name, unit, sizeof unit);
    const double factor = place < 0 ? NAN : to_reduced(unit, units);
    if (place < 0 && required)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: no column called %s", file, name);
    if (place >= 0 && isnan(factor))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: %s has the unit \"%s\", which is not known",
                              file, name, unit);
    for (size_t k = 0; k < table->rows; k++)
        values[k] = place < 0 ? NAN : factor * table->values[k * table->columns + (size_t)place];
    return STATUS_OK;
}

enum status mf_export_columns_read(struct export_columns *columns, const char *file,
                                   const struct units *units, const char *const *names,
                                   size_t required) {
    enum status status = STATUS_OK;
    struct data_table table = {0};
    size_t count = 0;
    *columns = (struct export_columns){0};
    while (names[count])
        count++;
    CHECK(mf_data_table_read(&table, file, required));
    columns->rows = table.rows;
    NEW_ARRAY(columns->values, count * table.rows);
    for (size_t c = 0; c < count; c++)
        CHECK(take_column(&table, file, units, names[c], c < required,
                          columns->values + c * table.rows));
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
