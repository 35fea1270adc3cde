// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/beads_gsd.h"

#include "io/gsd.h"

#include <math.h>
#include <string.h>

/// What a frame is made of, in this order; what beads are stands in frame 0 alone.
enum chunk { STEP, BOX, COUNT, TYPES, TYPE, MASS, POSITION, IMAGE, VELOCITY, CHUNKS };

static const struct {
    const char *name;
    enum gsd_type type;
    unsigned bytes, columns; ///< bytes of a number
    bool first;              ///< in frame 0 alone
} chunks[CHUNKS] = {
    [STEP] = {"configuration/step", GSD_UINT64, 8, 1, false},
    [BOX] = {"configuration/box", GSD_FLOAT, 4, 1, false},
    [COUNT] = {"particles/N", GSD_UINT32, 4, 1, true},
    [TYPES] = {"particles/types", GSD_INT8, 1, GSD_NAME, true},
    [TYPE] = {"particles/typeid", GSD_UINT32, 4, 1, true},
    [MASS] = {"particles/mass", GSD_FLOAT, 4, 1, true},
    [POSITION] = {"particles/position", GSD_FLOAT, 4, 3, false},
    [IMAGE] = {"particles/image", GSD_INT32, 4, 3, false},
    [VELOCITY] = {"particles/velocity", GSD_FLOAT, 4, 3, false},
};

/// 0: the frame has no such chunk.
static size_t rows_of(const struct beads_file *file, enum chunk chunk, size_t frame) {
    const struct mapping *const mapping = file->mapping;
    if (chunks[chunk].first && frame > 0)
        return 0;
    switch (chunk) {
    case STEP:
    case COUNT:
        return 1;
    case BOX:
        return 6;
    case TYPES:
        return mapping->types;
    case MASS:
        for (size_t k = 0; k < mapping->beads; k++)
            if (!isfinite(mapping->bead[k].mass))
                return 0;
        return mapping->beads;
    case VELOCITY:
        return file->has_velocities ? mapping->beads : 0;
    case IMAGE:
        return file->has_images ? mapping->beads : 0;
    default:
        return mapping->beads;
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
static void put_box(const struct trajectory_frame *beads, FILE *stream) {
    const double(*const box)[3] = (const double(*)[3])beads->box;
    for (int d = 0; d < 3; d++)
        mf_gsd_put_float(stream, box[d][d]);
    mf_gsd_put_float(stream, beads->has_box ? box[1][0] / box[1][1] : 0);
    mf_gsd_put_float(stream, beads->has_box ? box[2][0] / box[2][2] : 0);
    mf_gsd_put_float(stream, beads->has_box ? box[2][1] / box[2][2] : 0);
}

/// Which image of the box, whose middle is 0, a bead is in, and where it is in that.
static void find_image(const struct trajectory_frame *beads, double x[3], int32_t image[3]) {
    for (int i = 2; i >= 0; i--) {
        const double boxes = beads->has_box ? floor(x[i] / beads->box[i][i] + 0.5) : 0;
        image[i] = (int32_t)boxes;
        for (int d = 0; d < 3; d++)
            x[d] -= boxes * beads->box[i][d];
    }
}

static void put_places(const struct beads_file *file, const struct trajectory_frame *beads,
                       bool images) {
    for (size_t n = 0; n < beads->atoms; n++) {
        double x[3];
        int32_t image[3];
        memcpy(x, beads->position[file->order[n]], sizeof x);
        find_image(beads, x, image);
        for (int d = 0; d < 3; d++)
            if (images)
                mf_gsd_put(file->output.stream, (uint32_t)image[d], 4);
            else
                mf_gsd_put_float(file->output.stream, x[d]);
    }
}

/// What each bead is.
static void put_beads(const struct beads_file *file, enum chunk chunk) {
    FILE *const stream = file->output.stream;
    for (size_t n = 0; n < file->mapping->beads; n++) {
        const struct mapping_bead *const bead = &file->mapping->bead[file->order[n]];
        if (chunk == TYPE)
            mf_gsd_put(stream, bead->type, 4);
        else
            mf_gsd_put_float(stream, bead->mass);
    }
}

static void put_chunk(const struct beads_file *file, const struct trajectory_frame *beads,
                      enum chunk chunk) {
    FILE *const stream = file->output.stream;
    if (chunk == STEP)
        mf_gsd_put(stream, beads->step >= 0 ? (uint64_t)beads->step : (uint64_t)file->frames, 8);
    else if (chunk == BOX)
        put_box(beads, stream);
    else if (chunk == COUNT)
        mf_gsd_put(stream, beads->atoms, 4);
    else if (chunk == TYPES)
        for (size_t k = 0; k < file->mapping->types; k++)
            mf_gsd_put_text(stream, file->mapping->type_name[k], GSD_NAME);
    else if (chunk == POSITION || chunk == IMAGE)
        put_places(file, beads, chunk == IMAGE);
    else if (chunk == VELOCITY)
        for (size_t n = 0; n < beads->atoms; n++)
            for (int d = 0; d < 3; d++)
                mf_gsd_put_float(stream, beads->velocity[file->order[n]][d]);
    else
        put_beads(file, chunk);
}

enum status mf_beads_gsd_print(struct beads_file *file, const struct trajectory_frame *beads) {
    if (file->frames == 0) {
        file->has_velocities = beads->has_velocities;
        file->has_images = beads->unwrapped;
        mf_gsd_put_head(file->output.stream, 0, 0, 0); // in its place until the end is known
    }
    TRY(check(file, beads));
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        if (rows_of(file, (enum chunk)chunk, file->frames) > 0)
            put_chunk(file, beads, (enum chunk)chunk);
    return STATUS_OK;
}

void mf_beads_gsd_finish(struct beads_file *file) {
    FILE *const stream = file->output.stream;
    uint64_t at = GSD_HEAD, entries = 0;
    const int64_t index = ftello(stream);
    for (size_t frame = 0; frame < file->frames; frame++)
        for (int chunk = 0; chunk < CHUNKS; chunk++) {
            const size_t rows = rows_of(file, (enum chunk)chunk, frame);
            const struct gsd_entry entry = {.frame = frame,
                                            .rows = rows,
                                            .at = at,
                                            .columns = chunks[chunk].columns,
                                            .id = chunk,
                                            .type = chunks[chunk].type};
            if (rows == 0)
                continue;
            mf_gsd_put_entry(stream, &entry);
            entries++;
            at += (uint64_t)rows * chunks[chunk].columns * chunks[chunk].bytes;
        }
    size_t names = 0;
    for (int chunk = 0; chunk < CHUNKS; names += strlen(chunks[chunk].name) + 1, chunk++)
        mf_gsd_put_text(stream, chunks[chunk].name, strlen(chunks[chunk].name) + 1);
    mf_gsd_put_text(stream, "", (size_t)CHUNKS * GSD_NAME - names);
    if (fseeko(stream, 0, SEEK_SET) == 0)
        mf_gsd_put_head(stream, (uint64_t)index, entries, CHUNKS);
}
