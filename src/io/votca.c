// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/votca.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static enum status check_row(const struct data_table *table, const char *file, size_t row) {
    const char flag = table->flags[row];
    if (strchr("iou", flag) == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: the flag \"%c\" is not i, o or u", file,
                              table->line[row], flag);
    for (size_t column = 0; flag == 'i' && column < table->columns; column++)
        if (!isfinite(table->values[row * table->columns + column]))
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu: nan in a row flagged i",
                                  file, table->line[row], column + 1);
    return STATUS_OK;
}

/// Rows begin … end − 1 are those from the first flagged i to the last.
static enum status find_range(const struct data_table *table, const char *file, size_t *begin,
                              size_t *end) {
    *begin = table->rows;
    *end = 0;
    for (size_t row = 0; row < table->rows; row++) {
        TRY(check_row(table, file, row));
        if (table->flags[row] != 'i')
            continue;
        *begin = row < *begin ? row : *begin;
        *end = row + 1;
    }
    if (*end == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: no row is flagged i", file);
    for (size_t row = *begin; row < *end; row++)
        if (table->flags[row] != 'i')
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: flagged %c between rows that are flagged i", file,
                                  table->line[row], table->flags[row]);
    return STATUS_OK;
}

/// A table of two columns without flags is in range from end to end.
static enum status read_table(struct data_table *table, const char *file) {
    enum status status = mf_data_table_read(table, file, 2);
    if (status != STATUS_OK || table->columns != 2) {
        mf_data_table_clear(table);
        return mf_data_table_read_flagged(table, file, 1);
    }
    NEW_ARRAY(table->flags, table->rows);
    memset(table->flags, 'i', table->rows);
done:
    return status;
}

enum status mf_votca_read(struct votca_table *votca, const char *file) {
    enum status status = STATUS_OK;
    struct data_table table = {0};
    size_t begin, end;
    *votca = (struct votca_table){0};
    CHECK(read_table(&table, file));
    if (table.columns != 2 && table.columns != 3) {
        status = mf_status_fail(STATUS_BAD_INPUT,
                                "%s:%zu: not \"x y flag\" or \"x y error flag\" as VOTCA writes it",
                                file, table.line[0]);
        goto done;
    }
    CHECK(find_range(&table, file, &begin, &end));
    votca->rows = end - begin;
    votca->has_error = table.columns == 3;
    NEW_ARRAY(votca->x, votca->rows);
    NEW_ARRAY(votca->y, votca->rows);
    NEW_ARRAY(votca->error, votca->rows);
    NEW_ARRAY(votca->line, votca->rows);
    for (size_t k = 0; k < votca->rows; k++) {
        const double *row = table.values + (begin + k) * table.columns;
        votca->x[k] = row[0];
        votca->y[k] = row[1];
        votca->error[k] = votca->has_error ? row[2] : 0;
        votca->line[k] = table.line[begin + k];
    }
done:
    mf_data_table_clear(&table);
    if (status != STATUS_OK)
        mf_votca_clear(votca);
    return status;
}

void mf_votca_clear(struct votca_table *table) {
    mf_memory_free(table->x);
    mf_memory_free(table->y);
    mf_memory_free(table->error);
    mf_memory_free(table->line);
    *table = (struct votca_table){0};
}

enum status mf_votca_write(const char *file, const double *x, const double *y,
                           struct votca_scale scale, size_t rows, size_t first) {
    struct output output;
    TRY(mf_output_open(&output, file));
    for (size_t k = 0; k < rows; k++)
        fprintf(output.stream, "%.10g %.10g %c\n", scale.x * x[k], scale.y * y[k],
                k < first ? 'o' : 'i');
    return mf_output_commit(&output);
}
