// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/target_curve.h"

#include "base/memory.h"
#include "input/target_rdf.h"
#include "io/data_table.h"

#include "io/units_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CURVE(name) .offset = offsetof(struct target_curve_parameters, name)
#define COLUMN .maximum = 1000, .unit = ""
#define VALUE_COLUMNS                                                                              \
    {"value_column",                                                                               \
     FIELD_INTEGER,                                                                                \
     CURVE(value_column),                                                                          \
     .initial = 0,                                                                                 \
     .minimum = 0,                                                                                 \
     COLUMN,                                                                                       \
     .help = "column of the values; 0: that named as the target, else 2"},                         \
        {"error_column",                                                                           \
         FIELD_INTEGER,                                                                            \
         CURVE(error_column),                                                                      \
         .initial = -1,                                                                            \
         .minimum = -1,                                                                            \
         COLUMN,                                                                                   \
         .help = "column of the standard errors; 0: none; -1: that named as the target "           \
                 "with \"_error\", else 3 if present"},                                            \
        FIELD_END

const struct field mf_target_curve_time_fields[] = {
    {"file", FIELD_FILE, CURVE(file), .required = true, .unit = "",
     .help = "values at equally spaced times from 0, in units of the scene"},
    {"time_column", FIELD_INTEGER, CURVE(x_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "column of the times, from 1"},
    VALUE_COLUMNS,
};

const struct field mf_target_curve_fields[] = {
    {"file", FIELD_FILE, CURVE(file), .required = true, .unit = "",
     .help = "values at increasing x, in units of the scene"},
    {"x_column", FIELD_INTEGER, CURVE(x_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "column of x, from 1"},
    VALUE_COLUMNS,
};

#define NUMBER(name) .offset = offsetof(struct target_number, name)
const struct field mf_target_curve_number_fields[TARGET_NUMBER_FIELDS] = {
    {"value", FIELD_NUMBER, NUMBER(value), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "its own", .help = "measured value"},
    {"error", FIELD_NUMBER, NUMBER(error), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "its own", .help = "standard error"},
    FIELD_END,
};

const struct field mf_target_curve_diffusion_fields[] = {
    {"window", FIELD_NUMBER, NUMBER(window), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "tau",
     .help = "window, over whose second half D is the slope of the MSD; 0: that of other targets, "
             "else 1.6"},
    FIELD_END,
};

void mf_target_curve_number_fields_of(const char *unit, struct field fields[TARGET_NUMBER_FIELDS]) {
    memcpy(fields, mf_target_curve_number_fields, sizeof mf_target_curve_number_fields);
    for (int k = 0; fields[k].name; k++)
        fields[k].unit = unit;
}

const struct field *mf_target_curve_fields_of(enum observable_form form) {
    return form == OBSERVABLE_CURVE ? mf_target_curve_fields : mf_target_curve_time_fields;
}

static double cell(const struct data_table *table, size_t row, int64_t column) {
    return table->values[row * table->columns + (size_t)column - 1];
}

/// Times must be 0, h, 2h, … to the digits of the file.
static enum status check_times(const struct target_curve *curve, const struct data_table *table) {
    const struct target_curve_parameters *p = &curve->parameters;
    for (size_t k = 0; k < table->rows; k++)
        if (fabs(cell(table, k, p->x_column) - (double)k * curve->interval) >
            0.01 * curve->interval)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: the times are not equally spaced from 0: keep rows at "
                                  "0, h, 2 h and so on",
                                  p->file, table->line[k]);
    return STATUS_OK;
}

/// Check the column of x, and find the interval of times.
static enum status check_points(struct target_curve *curve, enum observable_form form,
                                const struct data_table *table) {
    const struct target_curve_parameters *p = &curve->parameters;
    const bool of_time = form == OBSERVABLE_CURVE_OF_TIME;
    if (of_time && table->rows < 3)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: only %zu times", p->file, table->rows);
    TRY(mf_data_table_check_increasing(table, p->file, (size_t)p->x_column - 1,
                                       of_time ? 0 : -DBL_MAX));
    if (!of_time)
        return STATUS_OK;
    curve->interval = cell(table, table->rows - 1, p->x_column) / (double)(table->rows - 1);
    return check_times(curve, table);
}

/// Columns that the file does not number are found by their names, as in tables that `mesofit
/// simulate` writes.
static enum status read_table(const struct target_curve_parameters *p, const char *name,
                              struct data_table *table, int64_t *value, int64_t *error) {
    enum { USUAL = 2 };
    char error_name[64];
    const int64_t least = p->value_column > 0 ? p->value_column : USUAL;
    TRY(mf_data_table_read(table, p->file, (size_t)(p->x_column > least ? p->x_column : least)));
    snprintf(error_name, sizeof error_name, "%s_error", name);
    const int64_t named = (int64_t)mf_data_table_find(table, name),
                  error_named = (int64_t)mf_data_table_find(table, error_name);
    *value = p->value_column > 0 ? p->value_column : named > 0 ? named : USUAL;
    const bool by_name = p->error_column < 0 && error_named > 0;
    return mf_target_rdf_error_column(by_name ? error_named : p->error_column, p->x_column, *value,
                                      table, p->file, error);
}

/// The columns that are read, in reduced units.
static enum status convert(const struct target_curve_parameters *p,
                           const struct observable_target *about, int64_t value_column,
                           int64_t error_column, const struct units *units,
                           struct data_table *table) {
    char argument[UNITS_NAME_SIZE];
    size_t length;
    const char *unit = mf_units_text_in_brackets(about->argument, &length);
    snprintf(argument, sizeof argument, "%.*s", (int)length, unit);
    TRY(mf_data_table_convert(table, p->file, (size_t)p->x_column - 1, argument, units));
    TRY(mf_data_table_convert(table, p->file, (size_t)value_column - 1, about->unit, units));
    return error_column > 0
               ? mf_data_table_convert(table, p->file, (size_t)error_column - 1, about->unit, units)
               : STATUS_OK;
}

static enum status load(struct target_curve *curve, const struct observable_target *about,
                        const struct units *units, struct data_table *table) {
    enum status status = STATUS_OK;
    const struct target_curve_parameters *p = &curve->parameters;
    int64_t value_column, error_column;
    CHECK(read_table(p, about->name, table, &value_column, &error_column));
    CHECK(convert(p, about, value_column, error_column, units, table));
    CHECK(check_points(curve, about->form, table));
    NEW_ARRAY(curve->x, table->rows);
    NEW_ARRAY(curve->value, table->rows);
    NEW_ARRAY(curve->error, table->rows);
    for (size_t k = 0; k < table->rows; k++) {
        curve->x[k] = cell(table, k, p->x_column);
        curve->value[k] = cell(table, k, value_column);
        curve->error[k] = error_column ? cell(table, k, error_column) : 0;
        const bool known = isfinite(curve->value[k]);
        if (known && curve->error[k] >= 0)
            continue;
        status = mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %lld: %g is not a %s", p->file,
                                table->line[k], (long long)(known ? error_column : value_column),
                                known ? curve->error[k] : curve->value[k],
                                known ? "standard error" : "finite number");
        goto done;
    }
    curve->points = table->rows;
done:
    return status;
}

enum status mf_target_curve_read(struct target_curve *curve, const struct observable_target *about,
                                 struct json_object *object) {
    const size_t faults = mf_json_fault_count(object->document);
    mf_json_fields(object, mf_target_curve_fields_of(about->form), &curve->parameters);
    mf_json_finish(object);
    if (mf_json_fault_count(object->document) > faults)
        return STATUS_OK;
    curve->time = mf_json_factor(object, "tau");
    struct data_table table = {0};
    const enum status status = load(curve, about, mf_json_units(object), &table);
    mf_data_table_clear(&table);
    if (status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK)
        mf_json_fault(object, "file", "%s", mf_status_message());
    return STATUS_OK;
}

void mf_target_curve_clear(struct target_curve *curve) {
    mf_memory_free(curve->x);
    mf_memory_free(curve->value);
    mf_memory_free(curve->error);
    *curve = (struct target_curve){0};
}

enum status mf_target_curve_check_steps(const struct target_curve *curve, double time_step) {
    const double steps = curve->interval / time_step, time = curve->time > 0 ? curve->time : 1;
    if (!(curve->interval > 0) || (steps > 0.5 && fabs(steps / fmax(1, round(steps)) - 1) < 1e-3))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: its interval %.6g is not a whole number of time steps of %g; %.6g "
                          "would do",
                          curve->parameters.file, time * curve->interval, time * time_step,
                          time * curve->interval / fmax(1, ceil(steps)));
}
