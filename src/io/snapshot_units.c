// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "io/snapshot.h"
#include "system/attributes.h"

#include <string.h>

const char *mf_snapshot_unit(const struct snapshot_column *column) {
    static const char *const known[][2] = {
        {"position", "lambda"}, {"velocity", "lambda/tau"}, {"force", "k_B T_0/lambda"}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(column->name, known[k][0]) == 0)
            return known[k][1];
    for (const struct field *field = mf_attributes_fields; field->name; field++)
        if (strcmp(column->name, field->name) == 0)
            return field->unit;
    return "";
}

static const char *name_units(const struct units *units) {
    if (!mf_units_are_physical(units))
        return "lj";
    return units->system == UNITS_NM_PS ? "nm-ps" : "real";
}

enum status mf_snapshot_translate(struct snapshot *converted, const struct snapshot *from,
                                  const struct units *units) {
    mf_snapshot_clear(converted);
    *converted = *from;
    converted->memory = mf_memory_zeroed(from->numbers, sizeof(double));
    if (converted->memory == NULL) {
        *converted = (struct snapshot){0};
        return STATUS_NO_MEMORY;
    }
    converted->units = name_units(units);
    converted->time = mf_units_file_value(from->time, mf_units_factor(units, "tau"));
    for (int d = 0; d < from->box.dimensions; d++)
        converted->box.length[d] =
            mf_units_file_value(from->box.length[d], mf_units_factor(units, "lambda"));
    for (int n = 0; n < from->columns; n++) {
        const struct snapshot_column *column = &from->column[n];
        const double factor = mf_units_factor(units, mf_snapshot_unit(column));
        const size_t numbers = (size_t)column->components * from->count;
        double *values = converted->memory + (column->values - from->memory);
        for (size_t k = 0; k < numbers; k++)
            values[k] = column->values[k] * factor;
        converted->column[n].values = values;
    }
    return STATUS_OK;
}
