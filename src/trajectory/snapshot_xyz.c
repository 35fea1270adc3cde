// SPDX-License-Identifier: GPL-3.0-or-later
//
// Snapshots as extended XYZ: "species" is an element or X, as ASE wants it, and "name" the type's
// own name.
#include "trajectory/elements.h"
#include "trajectory/snapshot.h"

#include <string.h>

static int width_of(const struct snapshot_column *column) {
    return column->vector ? 3 : column->components;
}

/// Readers know some columns by names of their own.
static const char *name_of(const struct snapshot_column *column) {
    static const char *const known[][2] = {
        {"position", "pos"}, {"velocity", "velo"}, {"force", "forces"}, {"mass", "masses"}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(column->name, known[k][0]) == 0)
            return known[k][1];
    return column->name;
}

static void print_snapshot_heading(const struct snapshot *snapshot, FILE *stream) {
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
    fprintf(stream, "%s:id:I:1:type:I:1:name:S:1\n",
            mf_snapshot_has_common_mass(snapshot) ? ":masses:R:1" : "");
}

static void print_snapshot(const struct snapshot *snapshot, FILE *stream) {
    print_snapshot_heading(snapshot, stream);
    for (size_t k = 0; k < snapshot->count; k++) {
        const char *const name = mf_snapshot_type_name(snapshot, k);
        fputs(mf_elements_symbol(name), stream);
        for (int n = 0; n < snapshot->columns; n++) {
            const struct snapshot_column *column = &snapshot->column[n];
            for (int c = 0; c < width_of(column); c++)
                fprintf(stream, " %.10g",
                        c < column->components ? column->values[(size_t)c * snapshot->count + k]
                                               : 0);
        }
        if (mf_snapshot_has_common_mass(snapshot))
            fprintf(stream, " %.10g", mf_snapshot_mass(snapshot, k));
        fprintf(stream, " %zu %d %s\n", k, mf_snapshot_type(snapshot, k) + 1, name);
    }
}

const struct snapshot_format mf_snapshot_xyz = {.name = "extxyz",
                                                .suffix = "extxyz",
                                                .appended = true,
                                                .angstrom = true,
                                                .print = print_snapshot};
