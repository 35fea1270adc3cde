// SPDX-License-Identifier: GPL-3.0-or-later
//
// Snapshots of a scene and frames of beads as GSD of HOOMD-blue, as OVITO, VMD and MDAnalysis read
// it. The box is centred at 0. The file says no units: a snapshot's numbers are those of all
// snapshots, beads' are in nm, ps and u. What beads are stands in frame 0 alone.
#include "trajectory/beads_file.h"
#include "trajectory/binary.h"
#include "trajectory/gsd.h"
#include "trajectory/snapshot.h"

#include <math.h>
#include <string.h>

// A snapshot --------------------------------------------------------------------------------------

static int count_types(const struct snapshot *snapshot) {
    return snapshot->count > 0 ? mf_snapshot_type(snapshot, snapshot->count - 1) + 1 : 1;
}

/// What particles are stands in the first frame alone.
static size_t rows_of_first(const struct snapshot *snapshot, enum gsd_chunk chunk) {
    const size_t bonds =
        snapshot->topology ? mf_topology_terms(snapshot->topology, BONDED_BOND) : 0;
    switch (chunk) {
    case DIMENSIONS:
    case COUNT:
        return 1;
    case TYPES:
        return (size_t)count_types(snapshot);
    case TYPE:
        return snapshot->count;
    case MASS:
        return mf_snapshot_has_masses(snapshot) ? snapshot->count : 0;
    case BONDS:
    case BOND_TYPES:
        return bonds > 0;
    case BOND_TYPE:
    case BOND:
        return bonds;
    default:
        return 0;
    }
}

static size_t snapshot_rows(const void *context, enum gsd_chunk chunk, size_t frame) {
    const struct snapshot *const snapshot = context;
    switch (chunk) {
    case STEP:
        return 1;
    case BOX:
        return 6;
    case POSITION:
    case VELOCITY:
    case IMAGE:
        return snapshot->count;
    default:
        return frame == 0 ? rows_of_first(snapshot, chunk) : 0;
    }
}

/// Three components, of which the third is 0 in two dimensions; places are about the middle.
static void put_column(const struct snapshot *snapshot, enum gsd_chunk chunk, FILE *stream) {
    const char *const name = strrchr(mf_gsd_name(chunk), '/') + 1;
    const struct snapshot_column *const column = mf_snapshot_find(snapshot, name);
    for (size_t k = 0; k < snapshot->count; k++)
        for (int d = 0; d < 3; d++) {
            const bool there = d < column->components;
            const double value = there ? column->values[(size_t)d * snapshot->count + k] : 0;
            const double middle = chunk == POSITION && there ? snapshot->box.length[d] / 2 : 0;
            if (column->whole)
                mf_gsd_put(chunk, (int64_t)value, stream);
            else
                mf_gsd_put_real(value - middle, stream);
        }
}

static void put_masses(const struct snapshot *snapshot, FILE *stream) {
    for (size_t k = 0; k < snapshot->count; k++)
        mf_gsd_put_real(mf_snapshot_mass(snapshot, k), stream);
}

static void put_type_names(const struct snapshot *snapshot, FILE *stream) {
    for (int type = 0; type < count_types(snapshot); type++) {
        size_t k = 0;
        while (k < snapshot->count && mf_snapshot_type(snapshot, k) != type)
            k++;
        mf_gsd_put_name(k < snapshot->count ? mf_snapshot_type_name(snapshot, k) : "", stream);
    }
}

static void put_bonds(const struct topology *topology, FILE *stream) {
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *const kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int t = 0; t < kind->terms[BONDED_BOND]; t++)
                for (int end = 0; end < 2; end++)
                    mf_gsd_put(BOND, topology_id(kind, m, kind->term[BONDED_BOND][t].bead[end]),
                               stream);
    }
}

static void put_lengths(const struct box *box, FILE *stream) {
    for (int k = 0; k < 6; k++)
        mf_gsd_put_real(k < box->dimensions ? box->length[k] : k == 2 ? 1 : 0, stream);
}

static void put_snapshot(const void *context, enum gsd_chunk chunk, FILE *stream) {
    const struct snapshot *const snapshot = context;
    const size_t rows = snapshot_rows(snapshot, chunk, 0);
    if (chunk == STEP)
        mf_gsd_put(chunk, (int64_t)snapshot->step, stream);
    else if (chunk == DIMENSIONS)
        mf_gsd_put(chunk, snapshot->box.dimensions, stream);
    else if (chunk == BOX)
        put_lengths(&snapshot->box, stream);
    else if (chunk == COUNT)
        mf_gsd_put(chunk, (int64_t)snapshot->count, stream);
    else if (chunk == TYPES)
        put_type_names(snapshot, stream);
    else if (chunk == MASS)
        put_masses(snapshot, stream);
    else if (chunk == POSITION || chunk == VELOCITY || chunk == IMAGE)
        put_column(snapshot, chunk, stream);
    else if (chunk == BONDS)
        mf_gsd_put(chunk, (int64_t)snapshot_rows(snapshot, BOND, 0), stream);
    else if (chunk == BOND_TYPES)
        mf_gsd_put_name("bond", stream);
    else if (chunk == BOND)
        put_bonds(snapshot->topology, stream);
    else
        for (size_t k = 0; k < rows; k++)
            mf_gsd_put(chunk, chunk == TYPE ? mf_snapshot_type(snapshot, k) : 0, stream);
}

static void print_snapshot(const struct snapshot *snapshot, FILE *stream) {
    const struct gsd_content content = {snapshot_rows, put_snapshot, snapshot};
    mf_gsd_put_frame(&content, snapshot->number, stream);
}

static void cut_snapshots(const struct snapshot *snapshot, size_t frames, FILE *stream) {
    const struct gsd_content content = {snapshot_rows, put_snapshot, snapshot};
    mf_gsd_cut(&content, frames, stream);
}

const struct snapshot_format mf_gsd_snapshot = {.name = "gsd",
                                                .suffix = "gsd",
                                                .appended = true,
                                                .print = print_snapshot,
                                                .cut = cut_snapshots};

// Beads -------------------------------------------------------------------------------------------

static size_t bead_rows(const void *context, enum gsd_chunk chunk, size_t frame) {
    const struct beads_file *const file = context;
    const struct mapping *const mapping = file->mapping;
    switch (chunk) {
    case STEP:
        return 1;
    case BOX:
        return 6;
    case COUNT:
        return frame == 0;
    case TYPES:
        return frame == 0 ? mapping->types : 0;
    case TYPE:
        return frame == 0 ? mapping->beads : 0;
    case MASS:
        return frame == 0 && mf_beads_file_has_masses(file) ? mapping->beads : 0;
    case POSITION:
        return mapping->beads;
    case VELOCITY:
        return file->has_velocities ? mapping->beads : 0;
    case IMAGE:
        return file->has_images ? mapping->beads : 0;
    default:
        return 0;
    }
}

static enum status check(const struct beads_file *file, const struct trajectory_frame *beads) {
    if (!beads->has_box)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: frame %zu has no box, and .gsd needs one: --beads takes .xyz, too", beads->file,
            beads->number);
    if (beads->box[0][1] != 0 || beads->box[0][2] != 0 || beads->box[1][2] != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu: GSD has boxes with a along x and b in the plane of x "
                              "and y: --beads takes .xyz or .gro, too",
                              beads->file, beads->number);
    if (file->has_velocities && !beads->has_velocities)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu has no velocities, as others have: --beads takes .xyz "
                              "or .gro, too",
                              beads->file, beads->number);
    return STATUS_OK;
}

/// Lengths and tilts.
static void put_box(const double box[3][3], FILE *stream) {
    for (int d = 0; d < 3; d++)
        mf_gsd_put_real(box[d][d], stream);
    mf_gsd_put_real(box[1][0] / box[1][1], stream);
    mf_gsd_put_real(box[2][0] / box[2][2], stream);
    mf_gsd_put_real(box[2][1] / box[2][2], stream);
}

/// Which image of the box, whose middle is 0, a bead is in, and where it is in that.
static void find_image(const struct trajectory_frame *beads, double x[3], int32_t image[3]) {
    for (int i = 2; i >= 0; i--) {
        const double boxes = floor(x[i] / beads->box[i][i] + 0.5);
        image[i] = (int32_t)boxes;
        for (int d = 0; d < 3; d++)
            x[d] -= boxes * beads->box[i][d];
    }
}

static void put_bead(const struct beads_file *file, size_t bead, enum gsd_chunk chunk,
                     FILE *stream) {
    double x[3];
    int32_t image[3];
    memcpy(x, file->beads->position[bead], sizeof x);
    find_image(file->beads, x, image);
    if (chunk == TYPE)
        mf_gsd_put(chunk, (int64_t)file->mapping->bead[bead].type, stream);
    else if (chunk == MASS)
        mf_gsd_put_real(file->mapping->bead[bead].mass, stream);
    for (int d = 0; d < 3; d++)
        if (chunk == IMAGE)
            mf_gsd_put(chunk, image[d], stream);
        else if (chunk == POSITION)
            mf_gsd_put_real(x[d], stream);
        else if (chunk == VELOCITY)
            mf_gsd_put_real(file->beads->velocity[bead][d], stream);
}

static void put_beads(const void *context, enum gsd_chunk chunk, FILE *stream) {
    const struct beads_file *const file = context;
    const struct mapping *const mapping = file->mapping;
    if (chunk == STEP)
        mf_gsd_put(chunk, beads_file_step(file, file->beads), stream);
    else if (chunk == BOX)
        put_box((const double(*)[3])file->beads->box, stream);
    else if (chunk == COUNT)
        mf_gsd_put(chunk, (int64_t)mapping->beads, stream);
    else if (chunk == TYPES)
        for (size_t k = 0; k < mapping->types; k++)
            mf_gsd_put_name(mapping->type_name[k], stream);
    else
        for (size_t n = 0; n < mapping->beads; n++)
            put_bead(file, file->order[n], chunk, stream);
}

enum status mf_gsd_print_beads(struct beads_file *file, const struct trajectory_frame *beads) {
    const struct gsd_content content = {bead_rows, put_beads, file};
    if (file->frames == 0) {
        file->has_velocities = beads->has_velocities;
        file->has_images = beads->unwrapped;
    }
    TRY(check(file, beads));
    file->beads = beads;
    mf_gsd_put_frame(&content, file->frames, file->output.stream);
    return STATUS_OK;
}
