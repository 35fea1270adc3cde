// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/target.h"

#include "base/memory.h"
#include "io/data_table.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct target_parameters, name)
#define COLUMN .maximum = 1000, .unit = ""
const struct field target_fields[] = {
    {"file", FIELD_FILE, MEMBER(file), .required = true, .unit = "",
     .help = "g(r) at equally spaced bin centres, in units of the scene"},
    {"r_column", FIELD_INTEGER, MEMBER(r_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "number of the column with the bin centres, from 1"},
    {"g_column", FIELD_INTEGER, MEMBER(g_column), .initial = 2, .minimum = 1, COLUMN,
     .help = "number of the column with g"},
    {"error_column", FIELD_INTEGER, MEMBER(error_column), .initial = 3, .minimum = 0, COLUMN,
     .help = "number of the column with the standard error of g; 0 if there is none"},
    {"particles", FIELD_INTEGER, MEMBER(particles), .initial = 0, .minimum = 0, .maximum = 1e9,
     .unit = "",
     .help = "of the system where it was measured, to correct for another number in "
             "the scene; 0 means the same"},
    FIELD_END,
};

static double cell(const struct data_table *table, size_t row, int64_t column) {
    return table->values[row * table->columns + (size_t)column - 1];
}

/// The row whose step from the one before is farthest from `width`, the mean step: with a gap, the
/// row behind it.
static size_t oddest_row(const struct data_table *table, int64_t column, double width,
                         double *step) {
    size_t oddest = 1;
    *step = width;
    for (size_t k = 1; k < table->rows; k++) {
        const double here = cell(table, k, column) - cell(table, k - 1, column);
        if (fabs(here - width) > fabs(*step - width)) {
            oddest = k;
            *step = here;
        }
    }
    return oddest;
}

/// Bins from their centres, which must be equally spaced to the digits of the file.
static enum status find_bins(const struct data_table *table, const struct target_parameters *p,
                             struct rdf_bins *bins) {
    TRY(data_table_check_increasing(table, p->file, (size_t)p->r_column - 1, 0));
    if (table->rows < 4)
        return status_fail(STATUS_BAD_INPUT, "%s: only %zu bins", p->file, table->rows);
    const double first = cell(table, 0, p->r_column);
    const double width =
        (cell(table, table->rows - 1, p->r_column) - first) / (double)(table->rows - 1);
    double step;
    const size_t oddest = oddest_row(table, p->r_column, width, &step);
    if (fabs(step / width - 1) > 0.01)
        return status_fail(STATUS_BAD_INPUT,
                           "%s:%zu: the bins are not equally spaced: a step of %g where the mean "
                           "is %g (a gap in the target?)",
                           p->file, table->line[oddest], step, width);
    // First edges come out as 0 but for the file's rounding.
    const double low = first - 0.5 * width;
    if (low < -0.01 * width)
        return status_fail(STATUS_BAD_INPUT,
                           "%s:%zu: r = %g is not the centre of a bin of width %g", p->file,
                           table->line[0], first, width);
    *bins = (struct rdf_bins){
        .low = fabs(low) < 0.01 * width ? 0 : low, .width = width, .count = table->rows};
    return STATUS_OK;
}

static enum status take_values(struct target *target, const struct data_table *table) {
    enum status status = STATUS_OK;
    const struct target_parameters *p = &target->parameters;
    NEW_ARRAY(target->g, table->rows);
    NEW_ARRAY(target->error, table->rows);
    for (size_t k = 0; k < table->rows; k++) {
        target->g[k] = cell(table, k, p->g_column);
        target->error[k] = p->error_column ? cell(table, k, p->error_column) : 0;
        if (target->g[k] < 0 || target->error[k] < 0) {
            status = status_fail(STATUS_BAD_INPUT, "%s:%zu: a negative g or error", p->file,
                                 table->line[k]);
            goto done;
        }
    }
done:
    return status;
}

static enum status load(struct target *target, struct data_table *table) {
    const struct target_parameters *p = &target->parameters;
    const int64_t most = p->r_column > p->g_column ? p->r_column : p->g_column;
    const int64_t columns = p->error_column > most ? p->error_column : most;
    TRY(data_table_read(table, p->file, (size_t)columns));
    TRY(find_bins(table, p, &target->bins));
    return take_values(target, table);
}

enum status target_read(struct target *target, struct json_object *object) {
    *target = (struct target){0};
    const size_t faults = json_fault_count(object->document);
    json_fields(object, target_fields, &target->parameters);
    json_finish(object);
    if (json_fault_count(object->document) > faults)
        return STATUS_OK;
    struct data_table table = {0};
    const enum status status = load(target, &table);
    data_table_clear(&table);
    if (status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK)
        json_fault(object, "file", "%s", status_message());
    return STATUS_OK;
}

void target_convert(struct target *target, size_t count) {
    if (target->parameters.particles == 0)
        return;
    const double factor = rdf_finite_size_factor((size_t)target->parameters.particles, count);
    for (size_t k = 0; k < target->bins.count; k++) {
        target->g[k] *= factor;
        target->error[k] *= factor;
    }
}

void target_clear(struct target *target) {
    memory_free(target->g);
    memory_free(target->error);
    *target = (struct target){0};
}
