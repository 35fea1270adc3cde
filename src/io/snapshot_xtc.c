// SPDX-License-Identifier: GPL-3.0-or-later
//
// GROMACS's compressed trajectory, as VMD, MDAnalysis and GROMACS read it: positions in the box, to
// 0.001 nm. Of a scene in reduced units 1 nm is λ, and 1 ps is τ.
#include "io/snapshot.h"
#include "io/xtc.h"

#include <string.h>

/// Of a nm in the snapshot's unit, and of a ps.
struct scale {
    double length, time;
};

static struct scale scale_of(const struct snapshot *snapshot) {
    const bool angstrom = snapshot->units && strcmp(snapshot->units, "real") == 0;
    return angstrom ? (struct scale){0.1, 1e-3} : (struct scale){1, 1};
}

/// The third coordinate is 0 in two dimensions.
static void place(const void *context, size_t particle, double position[3]) {
    const struct snapshot *const snapshot = context;
    const struct snapshot_column *column = snapshot->column;
    const double scale = scale_of(snapshot).length;
    while (strcmp(column->name, "position") != 0)
        column++;
    for (int d = 0; d < 3; d++)
        position[d] = d < column->components
                          ? scale * column->values[(size_t)d * snapshot->count + particle]
                          : 0;
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    const struct scale scale = scale_of(snapshot);
    struct xtc_frame frame = {.atoms = snapshot->count,
                              .step = (int64_t)snapshot->step,
                              .time = scale.time * snapshot->time,
                              .place = place,
                              .context = snapshot};
    for (int d = 0; d < 3; d++)
        frame.box[d][d] = d < snapshot->box.dimensions ? scale.length * snapshot->box.length[d] : 1;
    mf_xtc_write(&frame, stream);
}

const struct snapshot_format mf_snapshot_xtc = {
    .name = "xtc", .suffix = "xtc", .appended = true, .print = print};
