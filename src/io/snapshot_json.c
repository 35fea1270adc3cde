// SPDX-License-Identifier: GPL-3.0-or-later
//
// JSON with a list of numbers for each column, all of their digits, so that a scene can begin with
// it. Printed at once: a tree of a million particles would not fit into the memory.
#include "io/snapshot.h"

#include <math.h>
#include <stdlib.h>

static void print_number(double value, FILE *stream) {
    char text[32];
    snprintf(text, sizeof text, "%.15g", value);
    if (strtod(text, NULL) != value)
        snprintf(text, sizeof text, "%.17g", value);
    fputs(isfinite(value) ? text : "null", stream);
}

static void print_list(const char *name, const double *values, size_t count, FILE *stream) {
    fprintf(stream, ",\n    \"%s\": [", name);
    for (size_t k = 0; k < count; k++) {
        fputs(k == 0 ? "" : ", ", stream);
        print_number(values[k], stream);
    }
    fputs("]", stream);
}

static void print_types(const struct snapshot *snapshot, FILE *stream) {
    fprintf(stream, "    \"type\": [");
    for (size_t k = 0; k < snapshot->count; k++)
        fprintf(stream, "%s\"%s\"", k == 0 ? "" : ", ",
                mf_snapshot_type_name(snapshot->composition,
                                      mf_composition_type(snapshot->composition, (uint32_t)k)));
    fputs("]", stream);
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    fprintf(stream, "{\n  \"step\": %llu,\n  \"time\": ", (unsigned long long)snapshot->step);
    print_number(snapshot->time, stream);
    fprintf(stream, ",\n  \"count\": %zu,\n  \"box\": [", snapshot->count);
    for (int d = 0; d < snapshot->box.dimensions; d++) {
        fputs(d == 0 ? "" : ", ", stream);
        print_number(snapshot->box.length[d], stream);
    }
    fputs("],\n  \"particles\": {\n", stream);
    print_types(snapshot, stream);
    for (int n = 0; n < snapshot->columns; n++)
        for (int c = 0; c < snapshot->column[n].components; c++) {
            char name[SNAPSHOT_NAME_SIZE];
            mf_snapshot_component_name(&snapshot->column[n], c, name);
            print_list(name, snapshot->column[n].values + (size_t)c * snapshot->count,
                       snapshot->count, stream);
        }
    fputs("\n  }\n}\n", stream);
}

const struct snapshot_format mf_snapshot_json = {.name = "json", .suffix = "json", .print = print};
