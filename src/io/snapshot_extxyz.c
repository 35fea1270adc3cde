// SPDX-License-Identifier: GPL-3.0-or-later
//
// Extended XYZ, as ASE, OVITO and QUIP read it: the box and the columns stand in the second line of
// a frame. Vectors have three components, of which the third is 0 in two dimensions.
#include "io/snapshot.h"

#include <string.h>

static int width_of(const struct snapshot_column *column) {
    return column->vector ? 3 : column->components;
}

/// Readers know some columns by names of their own.
static const char *name_of(const struct snapshot_column *column) {
    static const char *const known[][2] = {
        {"position", "pos"}, {"velocity", "velo"}, {"force", "forces"}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(column->name, known[k][0]) == 0)
            return known[k][1];
    return column->name;
}

static void print_heading(const struct snapshot *snapshot, FILE *stream) {
    const struct box *box = &snapshot->box;
    fprintf(stream, "%zu\nLattice=\"%.10g 0 0 0 %.10g 0 0 0 %.10g\" pbc=\"T T %c\" ",
            snapshot->count, box->length[0], box->length[1], box->length[2],
            box->dimensions == 3 ? 'T' : 'F');
    if (snapshot->units)
        fprintf(stream, "Units=%s ", snapshot->units);
    fprintf(stream, "Step=%llu Time=%.10g Properties=species:S:1",
            (unsigned long long)snapshot->step, snapshot->time);
    for (int n = 0; n < snapshot->columns; n++)
        fprintf(stream, ":%s:%c:%d", name_of(&snapshot->column[n]),
                snapshot->column[n].whole ? 'I' : 'R', width_of(&snapshot->column[n]));
    fprintf(stream, ":id:I:1\n");
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    print_heading(snapshot, stream);
    for (size_t k = 0; k < snapshot->count; k++) {
        fputs(mf_snapshot_type_name(snapshot, k), stream);
        for (int n = 0; n < snapshot->columns; n++) {
            const struct snapshot_column *column = &snapshot->column[n];
            for (int c = 0; c < width_of(column); c++)
                fprintf(stream, " %.10g",
                        c < column->components ? column->values[(size_t)c * snapshot->count + k]
                                               : 0);
        }
        fprintf(stream, " %zu\n", k);
    }
}

const struct snapshot_format mf_snapshot_extxyz = {
    .name = "extxyz", .suffix = "extxyz", .appended = true, .print = print};
