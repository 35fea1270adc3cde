// SPDX-License-Identifier: GPL-3.0-or-later
//
// A text dump of LAMMPS, style custom, as OVITO and VMD read it and LAMMPS begins with it
// (read_dump): manual, command `dump`; the time stands behind "ITEM: NUMBER OF ATOMS", where
// MDAnalysis and old versions of OVITO, which know no "ITEM: TIME", do not mind it. It says no
// units: its numbers are those of all snapshots.
#include "io/snapshot.h"

#include <string.h>

static const struct snapshot_column *find(const struct snapshot *snapshot, const char *name) {
    for (int n = 0; n < snapshot->columns; n++)
        if (strcmp(snapshot->column[n].name, name) == 0)
            return &snapshot->column[n];
    return NULL;
}

/// Three components, of which the third is 0 in two dimensions.
static void print_vector(const struct snapshot *snapshot, const struct snapshot_column *column,
                         size_t particle, FILE *stream) {
    for (int c = 0; c < 3; c++)
        fprintf(stream, " %.10g",
                c < column->components ? column->values[(size_t)c * snapshot->count + particle]
                                       : 0);
}

static void print_heading(const struct snapshot *snapshot, FILE *stream) {
    const struct box *box = &snapshot->box;
    fprintf(stream, "ITEM: TIMESTEP\n%llu\nITEM: NUMBER OF ATOMS time=%.10g\n%zu\n",
            (unsigned long long)snapshot->step, snapshot->time, snapshot->count);
    fprintf(stream, "ITEM: BOX BOUNDS pp pp pp\n");
    for (int d = 0; d < box->dimensions; d++)
        fprintf(stream, "0 %.10g\n", box->length[d]);
    if (box->dimensions == 2) // as LAMMPS has two
        fprintf(stream, "-0.5 0.5\n");
    fprintf(stream, "ITEM: ATOMS id%s type x y z ix iy iz vx vy vz\n",
            find(snapshot, "molecule") ? " mol" : "");
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    const struct snapshot_column *position = find(snapshot, "position"),
                                 *image = find(snapshot, "image"),
                                 *velocity = find(snapshot, "velocity"),
                                 *molecule = find(snapshot, "molecule");
    print_heading(snapshot, stream);
    for (size_t k = 0; k < snapshot->count; k++) {
        fprintf(stream, "%zu", k + 1);
        if (molecule)
            fprintf(stream, " %.0f", molecule->values[k]);
        fprintf(stream, " %d", mf_snapshot_type(snapshot, k) + 1);
        print_vector(snapshot, position, k, stream);
        print_vector(snapshot, image, k, stream);
        print_vector(snapshot, velocity, k, stream);
        fprintf(stream, "\n");
    }
}

const struct snapshot_format mf_snapshot_lammps = {
    .name = "lammps-dump", .suffix = "lammpstrj", .appended = true, .print = print};
