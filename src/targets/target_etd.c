// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "io/data_table.h"
#include "targets/target_files.h"
#include "targets/target_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MEMBER(name) .offset = offsetof(struct target_etd_parameters, name)
#define COLUMN .maximum = 1000, .unit = ""
static const struct field etd_fields[] = {
    {"file", FIELD_FILE, MEMBER(file), .required = true, .unit = "",
     .help = "E(t, r_0): rows are times, columns bins of r_0, in units of the scene"},
    {"error_file", FIELD_FILE, MEMBER(error_file), .unit = "",
     .help = "table of the standard errors of E, same shape"},
    {"time_column", FIELD_INTEGER, MEMBER(time_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "column of the times, from 1"},
    {"first_column", FIELD_INTEGER, MEMBER(first_column), .initial = 2, .minimum = 2, COLUMN,
     .help = "column of the first bin, after the times; the others follow"},
    {"r_minimum", FIELD_NUMBER, MEMBER(r_minimum), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda", .help = "lower edge of the first bin"},
    {"r_maximum", FIELD_NUMBER, MEMBER(r_maximum), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "lambda",
     .help = "upper edge of the last bin; 0: edges from column names "
             "as \"E(r0=0.51)\""},
    FIELD_END,
};

/// Of a mean interval, for times that a file gives with few digits.
static const double time_tolerance = 0.01;

/// Of E(0) = 1.
static const double digits = 1e-6;

static double time_of(const struct data_table *table, const struct target_etd_parameters *p,
                      size_t row) {
    return table->values[row * table->columns + (size_t)p->time_column - 1];
}

static enum status check_columns(const struct target_etd_parameters *p) {
    if (p->time_column >= p->first_column)
        return mf_status_fail(STATUS_BAD_INPUT, "first_column %lld is not after time_column %lld",
                              (long long)p->first_column, (long long)p->time_column);
    return STATUS_OK;
}

static enum status check_range(const struct target_etd_parameters *p) {
    if (!(p->r_maximum > p->r_minimum))
        return mf_status_fail(STATUS_BAD_INPUT, "r_maximum %g is not above r_minimum %g",
                              p->r_maximum, p->r_minimum);
    return STATUS_OK;
}

static enum status find_interval(const struct data_table *table, const char *file,
                                 const struct target_etd_parameters *p, double *interval) {
    TRY(mf_data_table_check_increasing(table, file, (size_t)p->time_column - 1, 0));
    if (table->rows < 2)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: only one time", file);
    if (time_of(table, p, 0) != 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: the times begin at %g, not at 0", file,
                              table->line[0], time_of(table, p, 0));
    *interval = time_of(table, p, table->rows - 1) / (double)(table->rows - 1);
    for (size_t row = 1; row < table->rows; row++) {
        const double step = time_of(table, p, row) - time_of(table, p, row - 1);
        if (fabs(step / *interval - 1) > time_tolerance)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: the times are not equally spaced: this step is %.3g "
                                  "times the mean one; keep "
                                  "rows at 0, h, 2 h and so on",
                                  file, table->line[row], step / *interval);
    }
    return STATUS_OK;
}

/// Before a column of times, where E has probabilities that fall.
static enum status check_numbered(const struct data_table *table, const char *file,
                                  const struct target_etd_parameters *p) {
    const size_t time = (size_t)p->time_column - 1;
    if (time + 1 >= table->columns || !mf_data_table_numbers_rows(table, time) ||
        !mf_data_table_is_spaced(table, time + 1, DATA_ROUNDING))
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: column %zu numbers the rows, and column %zu grows as a time does: "
        "set \"time_column\" to %zu and \"first_column\" to that of the first bin",
        file, time + 1, time + 2, time + 2);
}

/// Read a matrix and check its numbers: those of E are probabilities, errors are not negative.
static enum status read_table(struct data_table *table, const char *file,
                              const struct target_etd_parameters *p, const struct units *units,
                              double largest) {
    const size_t before = (size_t)p->first_column - 1;
    TRY(mf_data_table_read(table, file, before));
    if (largest == 1)
        TRY(check_numbered(table, file, p));
    TRY(mf_data_table_convert(table, file, (size_t)p->time_column - 1, "tau", units));
    if (table->columns == before)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: %zu columns, at least %zu are needed",
                              file, table->line[0], before, before + 1);
    for (size_t row = 0; row < table->rows; row++)
        for (size_t column = before; column < table->columns; column++) {
            const double value = table->values[row * table->columns + column];
            if (value < 0 || value > largest)
                return mf_status_fail(
                    STATUS_BAD_INPUT, "%s:%zu: column %zu: %g is not %s%s", file, table->line[row],
                    column + 1, value, largest == 1 ? "from 0 to 1" : "a standard error",
                    column == before ? ": \"first_column\" is the first column of E" : "");
        }
    return STATUS_OK;
}

/// E(0) = 1 by definition.
static enum status check_beginning(const struct data_table *table,
                                   const struct target_etd_parameters *p) {
    for (size_t column = (size_t)p->first_column - 1; column < table->columns; column++)
        if (fabs(table->values[column] - 1) > digits)
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu: %g is not 1 at time 0",
                                  p->file, table->line[0], column + 1, table->values[column]);
    return STATUS_OK;
}

static enum status check_same(const struct data_table *table, const struct data_table *errors,
                              const struct target_etd *target) {
    const struct target_etd_parameters *p = &target->parameters;
    if (errors->rows != table->rows || errors->columns != table->columns)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: %zu rows and %zu columns, but %zu and %zu in %s", p->error_file,
                              errors->rows, errors->columns, table->rows, table->columns, p->file);
    for (size_t row = 0; row < table->rows; row++)
        if (!(fabs(time_of(errors, p, row) - time_of(table, p, row)) <=
              time_tolerance * target->interval))
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: time %g, but %g in %s", p->error_file,
                                  errors->line[row], time_of(errors, p, row),
                                  time_of(table, p, row), p->file);
    return STATUS_OK;
}

/// Copy the cells; `errors` without values stands for none.
static enum status take_values(struct target_etd *target, const struct data_table *table,
                               const struct data_table *errors) {
    enum status status = STATUS_OK;
    const struct target_etd_parameters *p = &target->parameters;
    const size_t before = (size_t)p->first_column - 1, bins = table->columns - before;
    NEW_ARRAY(target->survival, table->rows * bins);
    NEW_ARRAY(target->error, table->rows * bins);
    target->grid =
        (struct etd_grid){p->r_minimum, p->r_maximum, (int64_t)bins, (int64_t)table->rows};
    for (size_t row = 0; row < table->rows; row++)
        for (size_t bin = 0; bin < bins; bin++) {
            const size_t from = row * table->columns + before + bin, to = row * bins + bin;
            const double error = errors->values ? errors->values[from] : 0;
            const bool known = !isnan(table->values[from]) && !isnan(error);
            target->survival[to] = known ? table->values[from] : NAN;
            target->error[to] = known ? error : NAN;
            target->left_out += !known;
        }
    if (target->left_out == table->rows * bins)
        status = mf_status_fail(STATUS_BAD_INPUT, "%s: all values are nan", p->file);
done:
    return status;
}

/// Bins by the names of the first and the last column, "E(r0=…)", in the file's unit of length.
static enum status find_bins(struct target_etd_parameters *p, const struct data_table *table,
                             const struct units *units) {
    static const char mark[] = "r0=";
    const size_t bins = table->columns - (size_t)p->first_column + 1;
    double first = NAN, last = NAN;
    size_t names = 0;
    for (const char *at = table->header; (at = strstr(at, mark)); names++) {
        at += strlen(mark);
        last = strtod(at, NULL);
        first = names == 0 ? last : first;
    }
    if (names != bins || bins < 2 || !(last > first))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: r_maximum: missing, and the %zu columns have no names "
                              "\"E(r0=…)\" with increasing r0",
                              p->file, bins);
    const double factor = mf_units_factor(units, "lambda");
    const double width = (last - first) / (double)(bins - 1) / factor;
    p->r_minimum = fmax(0, first / factor - 0.5 * width);
    p->r_maximum = last / factor + 0.5 * width;
    return STATUS_OK;
}

static enum status load(struct target_etd *target, const struct units *units,
                        struct data_table *table, struct data_table *errors) {
    struct target_etd_parameters *p = &target->parameters;
    TRY(check_columns(p));
    TRY(read_table(table, p->file, p, units, 1));
    if (p->r_maximum == 0)
        TRY(find_bins(p, table, units));
    TRY(check_range(p));
    TRY(find_interval(table, p->file, p, &target->interval));
    TRY(check_beginning(table, p));
    if (p->error_file[0]) {
        TRY(read_table(errors, p->error_file, p, units, INFINITY));
        TRY(check_same(table, errors, target));
    }
    return take_values(target, table, errors);
}

enum status mf_target_etd_read(struct target_etd *target, struct json_object *object) {
    *target = (struct target_etd){0};
    const size_t faults = mf_json_fault_count(object->document);
    mf_json_fields(object, etd_fields, &target->parameters);
    mf_json_finish(object);
    if (mf_json_fault_count(object->document) > faults)
        return STATUS_OK;
    target->time = mf_json_factor(object, "tau");
    struct data_table table = {0}, errors = {0};
    const enum status status = load(target, mf_json_units(object), &table, &errors);
    mf_data_table_clear(&table);
    mf_data_table_clear(&errors);
    if (status != STATUS_OK)
        mf_target_etd_clear(target);
    return mf_target_rows_fault(object, NULL, status);
}

void mf_target_etd_clear(struct target_etd *target) {
    mf_memory_free(target->survival);
    mf_memory_free(target->error);
    *target = (struct target_etd){0};
}

static enum status read(struct target_files *files, int kind, struct json_object *object,
                        const struct target_scene *scene) {
    (void)scene;
    return mf_target_etd_read(files->own[kind], object);
}

static void clear(void *own) {
    mf_target_etd_clear(own);
}

static size_t cells_of(const struct target_etd *target) {
    return (size_t)(target->grid.times * target->grid.bins);
}

static struct target values(const struct target_files *files, int kind) {
    const struct target_etd *target = files->own[kind];
    return (struct target){.count = cells_of(target),
                           .value = target->survival,
                           .error = target->error,
                           .columns = (size_t)target->grid.bins};
}

/// One row a cell; what is not known is nan.
static bool find_table(const struct target_files *files, int kind, size_t n,
                       struct target_table *table) {
    *table = (struct target_table){.name = "etd_cells",
                                   .count = cells_of(files->own[kind]),
                                   .places = 2,
                                   .place = {"time[tau]", "r0[lambda]"},
                                   .beside = true,
                                   .place_format = "%.6f",
                                   .value_format = "%.6f"};
    return n == 0;
}

static void find_place(const struct target_files *files, int kind, const struct target_table *table,
                       size_t k, double at[2]) {
    const struct target_etd *target = files->own[kind];
    const struct etd_grid *grid = &target->grid;
    const size_t bins = (size_t)grid->bins;
    const double width = (grid->r_maximum - grid->r_minimum) / (double)bins;
    (void)table;
    at[0] = (double)(k / bins) * target->interval;
    at[1] = grid->r_minimum + ((double)(k % bins) + 0.5) * width;
}

const struct target_record mf_target_etd = {
    .topic = "etd-target",
    .summary = "\"etd\": escape times of pairs",
    .chief = "file",
    .fields = {etd_fields, mf_target_files_use_fields},
    .form = OBSERVABLE_OWN_FORM,
    .kinds = {"etd"},
    .size = sizeof(struct target_etd),
    .read = read,
    .clear = clear,
    .values = values,
    .table = find_table,
    .place = find_place,
};
