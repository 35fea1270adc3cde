// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_rows.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/votca.h"
#include "observe/sample_blocks.h"
#include "system/box.h"
#include "system/topology.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Where g is below, it is too steep for the scatter to be told from its slope.
static const double min_g = 0.2;

/// Fourth differences and how many are needed.
enum { TAPS = 5, MIN_DIFFERENCES = 12 };
static const double taps[TAPS] = {1, -4, 6, -4, 1};

/// Differences beyond three standard deviations are left out; the mean square of what a normal
/// distribution has within them, and the median square of all of it.
static const double clip = 9, clipped_mean = 0.9733, median_square = 0.4549;

void mf_target_rows_clear(struct target_rows *rows) {
    mf_memory_free(rows->x);
    mf_memory_free(rows->y);
    mf_memory_free(rows->error);
    mf_memory_free(rows->line);
    *rows = (struct target_rows){0};
}

enum status mf_target_rows_allocate(struct target_rows *rows, size_t count) {
    rows->count = count;
    TRY_ARRAY(rows->x, count);
    TRY_ARRAY(rows->y, count);
    TRY_ARRAY(rows->error, count);
    TRY_ARRAY(rows->line, count);
    return STATUS_OK;
}

// Files -------------------------------------------------------------------------------------------

static double cell(const struct data_table *table, size_t row, int64_t column) {
    return table->values[row * table->columns + (size_t)column - 1];
}

/// Whether a column has any number: nothing but nan stands for errors that are not known.
static bool is_known(const struct data_table *table, int64_t column) {
    bool known = false;
    for (size_t k = 0; k < table->rows; k++)
        known = known || isfinite(cell(table, k, column));
    return known;
}

/// Whether a line of the comments is that of errors of samples.
static bool says_samples(const char *comments) {
    static const char line[] = "# " SAMPLE_BLOCKS_COMMENT "\n";
    const char *found = strstr(comments, line);
    while (found && found != comments && found[-1] != '\n')
        found = strstr(found + 1, line);
    return found != NULL;
}

/// Columns that the file does not number are found by their names, as in tables that `mesofit
/// simulate` writes, or are the usual ones.
static enum status find_columns(struct target_columns *columns, const struct data_table *table) {
    enum { USUAL = 2, USUAL_ERROR };
    char name[TOPOLOGY_NAME_SIZE + 8];
    snprintf(name, sizeof name, "%s_error", columns->name ? columns->name : "");
    const int64_t own = columns->name ? (int64_t)mf_data_table_find(table, columns->name) : 0;
    const int64_t own_error = columns->name ? (int64_t)mf_data_table_find(table, name) : 0;
    if (columns->y == 0)
        columns->y = own > 0 ? own : USUAL;
    if (columns->error < 0 && own_error > 0)
        columns->error = own_error;
    if (columns->error > (int64_t)table->columns)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s:%zu: %zu columns, at least %lld are needed for \"error_column\"; 0 if "
            "the file has no errors",
            columns->file, table->line[0], table->columns, (long long)columns->error);
    if (columns->error < 0)
        columns->error = table->lammps == DATA_LAMMPS_AVERAGE || table->columns < USUAL_ERROR ||
                                 columns->x == USUAL_ERROR || columns->y == USUAL_ERROR
                             ? 0
                             : USUAL_ERROR;
    if (columns->error > 0 && !is_known(table, columns->error))
        columns->error = 0;
    columns->numbered = mf_data_table_numbers_rows(table, (size_t)columns->x - 1) &&
                        mf_data_table_is_spaced(table, (size_t)columns->y - 1, DATA_ROUNDING);
    columns->even = columns->numbered && columns->y < (int64_t)table->columns &&
                    mf_data_table_is_spaced(table, (size_t)columns->y - 1, DATA_EXACT);
    columns->errors_of_samples = columns->error > 0 && says_samples(table->comments);
    columns->is_usual_error =
        columns->error > 0 && columns->usual_error &&
        columns->error == (int64_t)mf_data_table_find(table, columns->usual_error);
    return STATUS_OK;
}

static bool is_energy(const char *unit) {
    static const char *const energies[] = {"kJ/mol", "kcal/mol", "k_B T_0", "k_B T", "kT", "eV"};
    for (size_t k = 0; k < sizeof energies / sizeof *energies; k++)
        if (strcmp(unit, energies[k]) == 0)
            return true;
    return false;
}

static enum status convert(struct data_table *table, const struct target_columns *columns,
                           const struct units *units) {
    const int64_t column[] = {columns->x, columns->y, columns->error};
    const char *const unit[] = {columns->x_unit, columns->y_unit, columns->y_unit};
    char given[DATA_UNIT_SIZE];
    if (columns->y_unit == NULL && mf_data_table_unit(table, (size_t)columns->y - 1, given) &&
        is_energy(given))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: column %lld is in %s by its heading, and what is wanted has no "
                              "unit: a potential?",
                              columns->file, (long long)columns->y, given);
    for (size_t k = 0; k < 3; k++)
        if (column[k] > 0 && unit[k])
            TRY(mf_data_table_convert(table, columns->file, (size_t)column[k] - 1, unit[k], units));
    return STATUS_OK;
}

enum status mf_target_rows_read(struct target_rows *rows, struct target_columns *columns,
                                const struct units *units) {
    CLEARED_BY(mf_data_table_clear) struct data_table table = {0};
    const int64_t min = columns->y > 0 ? columns->y : 2;
    const int64_t last = columns->x > min ? columns->x : min;
    // Columns that a table must have hold no nan.
    TRY(mf_data_table_read(&table, columns->file,
                           (size_t)(columns->may_be_unknown ? columns->x : last)));
    if (table.columns < (size_t)last)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s:%zu: %zu columns, at least %lld are needed (blanks, commas or "
                              "semicolons separate columns)",
                              columns->file, table.line[0], table.columns, (long long)last);
    TRY(find_columns(columns, &table));
    TRY(mf_data_table_check_increasing(&table, columns->file, (size_t)columns->x - 1,
                                       columns->min));
    TRY(convert(&table, columns, units));
    TRY(mf_target_rows_allocate(rows, table.rows));
    for (size_t k = 0; k < table.rows; k++) {
        rows->x[k] = cell(&table, k, columns->x);
        rows->y[k] = cell(&table, k, columns->y);
        rows->error[k] = columns->error > 0 ? cell(&table, k, columns->error) : 0;
        rows->line[k] = table.line[k];
    }
    rows->has_errors = columns->error > 0;
    return STATUS_OK;
}

enum status mf_target_rows_read_votca(struct target_rows *rows, const char *file) {
    struct votca_table table;
    TRY(mf_votca_read(&table, file));
    rows->count = table.rows;
    rows->x = table.x;
    rows->y = table.y;
    rows->error = table.error;
    rows->line = table.line;
    rows->has_errors = table.has_error;
    return STATUS_OK;
}

enum status mf_target_rows_fault(struct json_object *object, const char *key, enum status status) {
    if (status == STATUS_OK || status == STATUS_NO_MEMORY)
        return status;
    mf_json_fault(object, key, "%s", mf_status_marked());
    return STATUS_OK;
}

// g(r) --------------------------------------------------------------------------------------------

struct target_tail mf_target_rows_tail(const struct target_rows *rows) {
    const double from = 0.75 * rows->x[rows->count - 1];
    double count = 0, sum = 0, squares = 0;
    struct target_tail tail = {.grows = rows->y[rows->count - 1] > rows->y[0]};
    for (size_t k = 0; k < rows->count; k++) {
        tail.grows = tail.grows && (k == 0 || rows->y[k] >= rows->y[k - 1]);
        if (rows->x[k] <= from)
            continue;
        count++;
        sum += rows->y[k];
        squares += rows->y[k] * rows->y[k];
    }
    tail.mean = sum / count;
    tail.scatter = sqrt(fmax(0, squares / count - tail.mean * tail.mean));
    return tail;
}

static double width_of(const struct target_rows *rows) {
    return (rows->x[rows->count - 1] - rows->x[0]) / (double)(rows->count - 1);
}

/// Of the shell of row k; a centre that the file rounds may bring its begin below 0.
static double volume(const struct target_rows *rows, size_t k, double width) {
    const struct box space = {.dimensions = rows->dimensions == 2 ? 2 : 3};
    return mf_box_shell_volume(&space, fmax(0, rows->x[k] - 0.5 * width), rows->x[k] + 0.5 * width);
}

/// d²/Σ b_j² g_j/v_j of all differences where g is large enough; returns how many.
static size_t differences(const struct target_rows *rows, double *square) {
    const double width = width_of(rows);
    size_t count = 0;
    for (size_t k = 0; k + TAPS <= rows->count; k++) {
        double difference = 0, variance = 0, min = INFINITY;
        for (size_t j = 0; j < TAPS; j++) {
            difference += taps[j] * rows->y[k + j];
            variance += taps[j] * taps[j] * rows->y[k + j] / volume(rows, k + j, width);
            min = fmin(min, rows->y[k + j]);
        }
        if (min > min_g)
            square[count++] = difference * difference / variance;
    }
    return count;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double mf_target_rows_robust_mean(double *square, size_t count) {
    enum { ROUNDS = 5 };
    qsort(square, count, sizeof *square, compare);
    double variance = square[count / 2] / median_square;
    for (int round = 0; round < ROUNDS; round++) {
        double sum = 0;
        size_t within = 0;
        while (within < count && square[within] <= clip * variance)
            sum += square[within++];
        variance = within > 0 ? sum / (double)within / clipped_mean : 0;
    }
    return variance;
}

enum status mf_target_rows_scatter(const struct target_rows *rows, double *error) {
    enum status status = STATUS_OK;
    double *square = NULL;
    *error = NAN;
    NEW_ARRAY(square, rows->count);
    const size_t count = differences(rows, square);
    if (count < MIN_DIFFERENCES)
        goto done;
    const double variance = mf_target_rows_robust_mean(square, count);
    const double scatter = sqrt(variance / volume(rows, rows->count - 1, width_of(rows)));
    if (scatter > target_rows_min_scatter)
        *error = scatter;
done:
    mf_memory_free(square);
    return status;
}

void mf_target_rows_set_errors(struct target_rows *rows, double error) {
    const double width = width_of(rows), last = volume(rows, rows->count - 1, width);
    for (size_t k = 0; k < rows->count; k++)
        rows->error[k] = error * sqrt(rows->y[k] * last / volume(rows, k, width));
}

void mf_target_rows_join(struct target_rows *rows, size_t of) {
    const double width = width_of(rows);
    const size_t count = rows->count / of;
    for (size_t n = 0; n < count; n++) {
        double r = 0, whole = 0, g = 0, squares = 0;
        for (size_t k = n * of; k < (n + 1) * of; k++) {
            const double part = volume(rows, k, width);
            r += rows->x[k] / (double)of;
            whole += part;
            g += part * rows->y[k];
            squares += pow(part * rows->error[k], 2);
        }
        rows->x[n] = r;
        rows->y[n] = g / whole;
        rows->error[n] = sqrt(squares) / whole;
        rows->line[n] = rows->line[n * of];
    }
    rows->count = count;
}
