// SPDX-License-Identifier: GPL-3.0-or-later
//
// JSON with a list of numbers for each column, all of their digits, so that a scene can begin with
// it. Companions, with which none can, stand in an object of their own. Printed at once: a tree of
// a million particles would not fit into the memory.
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

/// An object with a list for each column of particles begin … end − 1.
static void print_group(const char *name, const struct snapshot *snapshot, size_t begin, size_t end,
                        FILE *stream) {
    fprintf(stream, ",\n  \"%s\": {\n    \"type\": [", name);
    for (size_t k = begin; k < end; k++)
        fprintf(stream, "%s\"%s\"", k == begin ? "" : ", ", mf_snapshot_type_name(snapshot, k));
    fputs("]", stream);
    for (int n = 0; n < snapshot->columns; n++) {
        const struct snapshot_column *column = &snapshot->column[n];
        for (int c = 0; c < column->components && (begin < snapshot->own || column->shared); c++) {
            char component[SNAPSHOT_NAME_SIZE];
            mf_snapshot_component_name(column, c, component);
            print_list(component, column->values + (size_t)c * snapshot->count + begin, end - begin,
                       stream);
        }
    }
    fputs("\n  }", stream);
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    fprintf(stream, "{\n  \"step\": %llu,\n  \"time\": ", (unsigned long long)snapshot->step);
    print_number(snapshot->time, stream);
    fprintf(stream, ",\n  \"count\": %zu,\n  \"box\": [", snapshot->own);
    for (int d = 0; d < snapshot->box.dimensions; d++) {
        fputs(d == 0 ? "" : ", ", stream);
        print_number(snapshot->box.length[d], stream);
    }
    fputs("]", stream);
    print_group("particles", snapshot, 0, snapshot->own, stream);
    if (snapshot->solvent_particles)
        print_group(snapshot->solvent_particles, snapshot, snapshot->own, snapshot->count, stream);
    fputs("\n}\n", stream);
}

const struct snapshot_format mf_snapshot_json = {.name = "json", .suffix = "json", .print = print};
