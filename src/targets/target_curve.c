// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "io/units_text.h"
#include "targets/target_files.h"
#include "targets/target_rows.h"

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
     .help = "column; 0: that named as the target, else 2"},                                       \
        {"error_column",                                                                           \
         FIELD_INTEGER,                                                                            \
         CURVE(error_column),                                                                      \
         .initial = -1,                                                                            \
         .minimum = -1,                                                                            \
         COLUMN,                                                                                   \
         .help = "errors; 0: none; -1: \"TARGET_error\", else 3 if present"},                      \
        FIELD_END

static const struct field time_fields[] = {
    {"file", FIELD_FILE, CURVE(file), .required = true, .unit = "",
     .help = "values at equally spaced times from 0, in units of the scene"},
    {"time_column", FIELD_INTEGER, CURVE(x_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "column of the times, from 1"},
    VALUE_COLUMNS,
};

static const struct field x_fields[] = {
    {"file", FIELD_FILE, CURVE(file), .required = true, .unit = "",
     .help = "values at increasing x, in units of the scene"},
    {"x_column", FIELD_INTEGER, CURVE(x_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "column of x, from 1"},
    VALUE_COLUMNS,
};

#define NUMBER(name) .offset = offsetof(struct target_number, name)
static const struct field number_fields[] = {
    {"value", FIELD_NUMBER, NUMBER(value), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "its own", .help = "measured value"},
    {"error", FIELD_NUMBER, NUMBER(error), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "its own", .help = "standard error"},
    FIELD_END,
};

static const struct field diffusion_fields[] = {
    {"window", FIELD_NUMBER, NUMBER(window), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "tau",
     .help = "window, over whose second half D is the slope of the MSD; 0: that of other targets, "
             "else 1.6"},
    FIELD_END,
};

/// Times must be 0, h, 2h, … to the digits of the file.
static enum status find_interval(struct target_curve *curve, const struct target_rows *rows) {
    const char *file = curve->parameters.file;
    curve->interval = rows->x[rows->count - 1] / (double)(rows->count - 1);
    for (size_t k = 0; k < rows->count; k++)
        if (fabs(rows->x[k] - (double)k * curve->interval) > 0.01 * curve->interval)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: the times are not equally spaced from 0: keep rows at "
                                  "0, h, 2 h and so on",
                                  file, rows->line[k]);
    return STATUS_OK;
}

/// Rows of a curve that has its own x, but not one of time, may be nan: they are left out.
static enum status check_values(struct target_rows *rows, const struct target_columns *columns) {
    size_t count = 0;
    for (size_t k = 0; k < rows->count; k++) {
        const bool finite = isfinite(rows->y[k]);
        if (columns->may_be_unknown && (isnan(rows->y[k]) || isnan(rows->error[k]))) {
            rows->y[k] = rows->error[k] = NAN;
            continue;
        }
        if (!finite || !(rows->error[k] >= 0))
            return mf_status_fail(
                STATUS_BAD_INPUT, "%s:%zu: column %lld: %g is not a %s", columns->file,
                rows->line[k], (long long)(finite ? columns->error : columns->y),
                finite ? rows->error[k] : rows->y[k], finite ? "standard error" : "finite number");
        count++;
    }
    return count > 0 ? STATUS_OK
                     : mf_status_fail(STATUS_BAD_INPUT, "%s: all values are nan", columns->file);
}

static enum status load(struct target_curve *curve, const struct observable_target *about,
                        const struct units *units, struct target_rows *rows) {
    const struct target_curve_parameters *p = &curve->parameters;
    const bool of_time = about->form == OBSERVABLE_CURVE_OF_TIME;
    char argument[UNITS_NAME_SIZE];
    size_t length;
    const char *unit = mf_units_text_in_brackets(about->argument, &length);
    snprintf(argument, sizeof argument, "%.*s", (int)length, unit);
    struct target_columns columns = {.file = p->file,
                                     .name = about->name,
                                     .x_unit = argument,
                                     .y_unit = about->unit,
                                     .min = of_time ? 0 : -DBL_MAX,
                                     .x = p->x_column,
                                     .y = p->value_column,
                                     .error = p->error_column,
                                     .may_be_unknown = !of_time};
    TRY(mf_target_rows_read(rows, &columns, units));
    if (columns.numbered && (rows->x[0] > 0 || columns.even)) // from 0 an MSD may grow, too
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: column %lld numbers the rows, and column %lld grows as %s "
                              "does: set \"%s\" to %lld and \"value_column\" to that of the values",
                              p->file, (long long)columns.x, (long long)columns.y,
                              of_time ? "a time" : "x", of_time ? "time_column" : "x_column",
                              (long long)columns.y);
    if (of_time && rows->count < 3)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: only %zu times", p->file, rows->count);
    if (of_time)
        TRY(find_interval(curve, rows));
    return check_values(rows, &columns);
}

static enum status read_curve(struct target_files *files, int kind, struct json_object *object,
                              const struct target_scene *scene) {
    struct target_curve *curve = files->own[kind];
    const struct observable_target *about = mf_observable_kind(kind).target;
    const size_t faults = mf_json_fault_count(object->document);
    (void)scene;
    mf_json_fields(object, mf_target_record(kind)->fields[0], &curve->parameters);
    mf_json_finish(object);
    if (mf_json_fault_count(object->document) > faults)
        return STATUS_OK;
    curve->time = mf_json_factor(object, "tau");
    struct target_rows rows = {0};
    const enum status status = load(curve, about, mf_json_units(object), &rows);
    if (status == STATUS_OK) {
        curve->points = rows.count;
        curve->x = rows.x;
        curve->value = rows.y;
        curve->error = rows.error;
        rows.x = rows.y = rows.error = NULL;
    }
    mf_target_rows_clear(&rows);
    return mf_target_rows_fault(object, "file", status);
}

/// Of the interval, for a whole number of steps: the length of a step makes no such difference.
static const double step_tolerance = 1e-3;

enum status mf_target_curve_check_steps(const char *file, double interval, double time,
                                        double time_step) {
    const double steps = interval / time_step, whole = rint(steps);
    char above[64] = "";
    if (whole >= 1 && fabs(whole / steps - 1) <= step_tolerance)
        return STATUS_OK;
    if (steps >= 1)
        snprintf(above, sizeof above, " or %.6g", time * interval / floor(steps));
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "the times of %s are %.6g apart, %.4g time steps of %g: not a whole number, "
        "as it would be with a time step of %.6g%s",
        file, time * interval, steps, time * time_step, time * interval / ceil(steps), above);
}

// Curves ------------------------------------------------------------------------------------------

static void clear_curve(void *own) {
    struct target_curve *curve = own;
    mf_memory_free(curve->x);
    mf_memory_free(curve->value);
    mf_memory_free(curve->error);
}

/// A function of time is given at its own times, which are equal; any other at its x.
static struct target curve_values(const struct target_files *files, int kind) {
    const struct target_curve *curve = files->own[kind];
    return (struct target){.count = curve->points,
                           .value = curve->value,
                           .error = curve->error,
                           .x = curve->interval > 0 ? NULL : curve->x};
}

static bool curve_table(const struct target_files *files, int kind, size_t n,
                        struct target_table *table) {
    const struct observable_target *about = mf_observable_kind(kind).target;
    const struct target_curve *curve = files->own[kind];
    const bool of_time = about->form == OBSERVABLE_CURVE_OF_TIME;
    *table = (struct target_table){.count = curve->points,
                                   .places = 1,
                                   .place = {about->argument},
                                   .beside = of_time,
                                   .values_beside = of_time};
    snprintf(table->name, sizeof table->name, "%s", about->name);
    return n == 0;
}

static void curve_place(const struct target_files *files, int kind,
                        const struct target_table *table, size_t k, double at[2]) {
    const struct target_curve *curve = files->own[kind];
    (void)table;
    at[0] = curve->interval > 0 ? (double)k * curve->interval : curve->x[k];
}

#define CURVE_RECORD                                                                               \
    .chief = "file", .size = sizeof(struct target_curve), .read = read_curve,                      \
    .clear = clear_curve, .values = curve_values, .table = curve_table, .place = curve_place

const struct target_record mf_target_curve_of_time = {
    .topic = "curve-target",
    .summary = "a function of time, as \"vacf\" and \"msd\", with its file",
    .fields = {time_fields, mf_target_files_use_fields},
    .form = OBSERVABLE_CURVE_OF_TIME,
    CURVE_RECORD,
};

const struct target_record mf_target_curve = {
    .topic = "function-target",
    .summary = "any other function, with its file and the settings of its observable",
    .fields = {x_fields, mf_target_files_use_fields},
    .form = OBSERVABLE_CURVE,
    CURVE_RECORD,
};

// Numbers -----------------------------------------------------------------------------------------

enum { NUMBER_FIELDS = sizeof number_fields / sizeof *number_fields };

/// Fields of value and error, with the unit of the kind.
static void number_fields_of(int kind, struct field fields[NUMBER_FIELDS]) {
    memcpy(fields, number_fields, sizeof number_fields);
    for (int k = 0; fields[k].name; k++)
        fields[k].unit = mf_observable_kind(kind).target->unit;
}

static enum status read_number(struct target_files *files, int kind, struct json_object *object,
                               const struct target_scene *scene) {
    struct field fields[NUMBER_FIELDS];
    (void)scene;
    number_fields_of(kind, fields);
    mf_json_fields(object, fields, files->own[kind]);
    mf_json_finish(object);
    return STATUS_OK;
}

static enum status read_diffusion(struct target_files *files, int kind, struct json_object *object,
                                  const struct target_scene *scene) {
    mf_json_fields(object, diffusion_fields, files->own[kind]);
    return read_number(files, kind, object, scene);
}

static void write_number(const struct target_files *files, int kind, struct json_writer *writer) {
    struct field fields[NUMBER_FIELDS];
    number_fields_of(kind, fields);
    mf_json_write_fields(writer, fields, files->own[kind]);
}

static void write_diffusion(const struct target_files *files, int kind,
                            struct json_writer *writer) {
    write_number(files, kind, writer);
    mf_json_write_fields(writer, diffusion_fields, files->own[kind]);
}

static struct target number_values(const struct target_files *files, int kind) {
    const struct target_number *number = files->own[kind];
    return (struct target){.count = 1, .value = &number->value, .error = &number->error};
}

#define NUMBER_RECORD                                                                              \
    .chief = "value", .form = OBSERVABLE_NUMBER, .size = sizeof(struct target_number),             \
    .values = number_values

const struct target_record mf_target_number = {
    .topic = "number-target",
    .summary = "a number, as \"pressure\"",
    .fields = {number_fields, mf_target_files_use_fields},
    .read = read_number,
    .write = write_number,
    NUMBER_RECORD,
};

const struct target_record mf_target_diffusion = {
    .topic = "diffusion-target",
    .summary = "\"diffusion\": D, which may have a window of its own",
    .fields = {number_fields, diffusion_fields, mf_target_files_use_fields},
    .kinds = {"diffusion"},
    .read = read_diffusion,
    .write = write_diffusion,
    NUMBER_RECORD,
};
