// SPDX-License-Identifier: GPL-3.0-or-later
//
// GSD of HOOMD-blue (gsd.readthedocs.io: file layer 1 and 2, schema hoomd): chunks of numbers by
// frame and name, found by an index; little-endian. What a frame does not have is as in frame 0,
// or else as the schema says; but velocities of frame 0 alone are no velocities of the others:
// HOOMD writes those of all frames only if "momentum" is dynamic. Its units are those of the
// simulation, which nothing tells.
#include "base/memory.h"
#include "io/gsd.h"
#include "trajectory/binary.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <string.h>

enum { LARGEST_VERSION = 2 };

enum chunk {
    STEP,
    DIMENSIONS,
    BOX,
    COUNT,
    TYPES,
    TYPE,
    MASS,
    POSITION,
    VELOCITY,
    IMAGE,
    BOND,
    CONSTRAINT,
    CHUNKS
};

/// `columns` 0: any number of them.
static const struct {
    const char *name;
    int type;
    size_t bytes, columns;
} chunks[CHUNKS] = {
    [STEP] = {"configuration/step", GSD_UINT64, 8, 1},
    [DIMENSIONS] = {"configuration/dimensions", GSD_UINT8, 1, 1},
    [BOX] = {"configuration/box", GSD_FLOAT, 4, 1},
    [COUNT] = {"particles/N", GSD_UINT32, 4, 1},
    [TYPES] = {"particles/types", GSD_INT8, 1, 0},
    [TYPE] = {"particles/typeid", GSD_UINT32, 4, 1},
    [MASS] = {"particles/mass", GSD_FLOAT, 4, 1},
    [POSITION] = {"particles/position", GSD_FLOAT, 4, 3},
    [VELOCITY] = {"particles/velocity", GSD_FLOAT, 4, 3},
    [IMAGE] = {"particles/image", GSD_INT32, 4, 3},
    [BOND] = {"bonds/group", GSD_UINT32, 4, 2},
    [CONSTRAINT] = {"constraints/group", GSD_UINT32, 4, 2},
};

struct gsd {
    struct bytes index; ///< as in the file
    size_t entries;     ///< that are used
    int64_t id[CHUNKS]; ///< of their names; −1: no frame has it
    bool moves;         ///< velocities are those of each frame
    uint32_t atoms;
    struct bytes types; ///< of the atoms in the first frame, as in the file; empty: all of type 0
};

/// What goes before the numbers of a frame in its raw bytes.
struct header {
    uint64_t step;
    double box[6]; ///< lengths and tilts
    bool has_velocities, has_images;
};

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 8 && memcmp(begin, "\xDF\x65\xDF\x65\xDF\x65\xDF\x65", 8) == 0;
}

// The file ----------------------------------------------------------------------------------------

static const unsigned char *entry(const struct gsd *gsd, size_t k) {
    return gsd->index.data + k * GSD_ENTRY;
}

static uint64_t frame_of(const struct gsd *gsd, size_t k) {
    return binary_long(entry(gsd, k), false);
}

static int64_t id_of(const struct gsd *gsd, size_t k) {
    const unsigned char *const at = entry(gsd, k) + 28;
    return at[0] | at[1] << 8;
}

/// Which chunks the list of names has: one after the other, in file layer 1 each in 64 bytes.
static void find_names(struct gsd *gsd, const struct bytes *list, unsigned version) {
    size_t at = 0;
    for (int64_t id = 0; at < list->size && list->data[at] != '\0'; id++) {
        const char *const name = (const char *)list->data + at;
        const size_t length = strnlen(name, list->size - at);
        for (int k = 0; k < CHUNKS; k++)
            if (strlen(chunks[k].name) == length && memcmp(chunks[k].name, name, length) == 0)
                gsd->id[k] = id;
        at += version == 1 ? GSD_NAME : length + 1;
    }
}

/// Entries of frames in their order, up to the first that is not used.
static enum status check_index(struct trajectory *trajectory) {
    struct gsd *const gsd = trajectory->state;
    const size_t all = gsd->index.size / GSD_ENTRY;
    while (gsd->entries < all && binary_long(entry(gsd, gsd->entries) + 16, false) != 0)
        gsd->entries++;
    for (size_t k = 0; k < gsd->entries; k++)
        if (frame_of(gsd, k) < (k > 0 ? frame_of(gsd, k - 1) : 0) ||
            frame_of(gsd, k) >= gsd->entries)
            return mf_source_fail_byte(&trajectory->source,
                                       "entry %zu of the index is of frame %llu: it is damaged", k,
                                       (unsigned long long)frame_of(gsd, k));
    if (gsd->entries == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the file has no frame", trajectory->file);
    trajectory->frames = frame_of(gsd, gsd->entries - 1) + 1;
    gsd->moves = trajectory->frames == 1;
    for (size_t k = 0; k < gsd->entries; k++)
        gsd->moves = gsd->moves || (frame_of(gsd, k) > 0 && id_of(gsd, k) == gsd->id[VELOCITY]);
    return STATUS_OK;
}

/// Append so many pieces of the file.
static enum status take_at(struct source *source, struct bytes *raw, uint64_t byte, uint64_t count,
                           uint64_t size) {
    TRY(mf_source_seek(source, byte));
    if (count > UINT64_MAX / size / 2)
        return mf_source_fail_byte(source, "%llu pieces of %llu bytes: the file is damaged",
                                   (unsigned long long)count, (unsigned long long)size);
    return mf_source_take(source, raw, count * size);
}

/// Magic number, where index and names are and how long, versions, and by what and for what.
static enum status read_head(struct trajectory *trajectory, struct bytes *head,
                             struct bytes *names) {
    struct source *const source = &trajectory->source;
    struct gsd *const gsd = trajectory->state;
    TRY(mf_source_take(source, head, GSD_HEAD));
    const unsigned char *const at = head->data;
    const unsigned version = binary_word(at + 44, false) >> 16;
    if (version > LARGEST_VERSION)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: GSD of version %u; 1 and 2 are read",
                              trajectory->file, version);
    if (strncmp((const char *)at + 112, "hoomd", GSD_NAME) != 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: GSD of the schema \"%.63s\"; hoomd is read",
                              trajectory->file, (const char *)at + 112);
    TRY(take_at(source, &gsd->index, binary_long(at + 8, false), binary_long(at + 16, false),
                GSD_ENTRY));
    TRY(take_at(source, names, binary_long(at + 24, false), binary_long(at + 32, false), GSD_NAME));
    find_names(gsd, names, version);
    return check_index(trajectory);
}

static enum status open_file(struct trajectory *trajectory) {
    struct gsd *const gsd = trajectory->state;
    struct bytes head = {0}, names = {0};
    for (int k = 0; k < CHUNKS; k++)
        gsd->id[k] = -1;
    const enum status status = read_head(trajectory, &head, &names);
    mf_source_free(&head);
    mf_source_free(&names);
    return status;
}

static void close_file(struct trajectory *trajectory) {
    struct gsd *const gsd = trajectory->state;
    mf_source_free(&gsd->index);
    mf_source_free(&gsd->types);
}

// Chunks ------------------------------------------------------------------------------------------

/// The entry of a chunk of a frame; NULL if it has none.
static const unsigned char *find(const struct gsd *gsd, uint64_t frame, enum chunk chunk) {
    size_t begin = 0, end = gsd->entries;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (frame_of(gsd, middle) < frame)
            begin = middle + 1;
        else
            end = middle;
    }
    for (size_t k = begin; k < gsd->entries && frame_of(gsd, k) == frame; k++)
        if (id_of(gsd, k) == gsd->id[chunk])
            return entry(gsd, k);
    return NULL;
}

/// Characters are bytes, and what writes indices says uint32 or int32.
static bool fits(int type, int wanted) {
    return type == wanted || (type == GSD_CHARACTER && wanted == GSD_INT8) ||
           (type == GSD_INT32 && wanted == GSD_UINT32);
}

/// Append the numbers of a chunk, or of that of frame 0, of `rows` rows, 0: any.
/// @param[out] rows_found  0: neither frame has it
static enum status take(struct trajectory *trajectory, uint64_t frame, enum chunk chunk,
                        uint64_t rows, struct bytes *raw, uint64_t *rows_found,
                        uint32_t *columns_found) {
    const struct gsd *const gsd = trajectory->state;
    struct source *const source = &trajectory->source;
    const unsigned char *at = find(gsd, frame, chunk);
    at = at ? at : find(gsd, 0, chunk);
    *rows_found = at ? binary_long(at + 8, false) : 0;
    if (*rows_found == 0)
        return STATUS_OK;
    const uint32_t columns = binary_word(at + 24, false);
    if (!fits(at[30], chunks[chunk].type) || (rows > 0 && *rows_found != rows) || columns == 0 ||
        (chunks[chunk].columns > 0 && columns != chunks[chunk].columns))
        return mf_source_fail_byte(source,
                                   "\"%s\" has %llu rows of %lu numbers of type %d, which it "
                                   "cannot have",
                                   chunks[chunk].name, (unsigned long long)*rows_found,
                                   (unsigned long)columns, at[30]);
    *columns_found = columns;
    return take_at(source, raw, binary_long(at + 16, false), *rows_found,
                   (uint64_t)columns * chunks[chunk].bytes);
}

/// The same of what may be missing, and whose columns are known.
static enum status take_if(struct trajectory *trajectory, uint64_t frame, enum chunk chunk,
                           uint64_t rows, struct bytes *raw, bool *there) {
    uint64_t found;
    uint32_t columns;
    TRY(take(trajectory, frame, chunk, rows, raw, &found, &columns));
    *there = found > 0;
    return STATUS_OK;
}

/// One number of up to 8 bytes; the usual one if the file has none.
static enum status take_number(struct trajectory *trajectory, uint64_t frame, enum chunk chunk,
                               uint64_t usual, struct bytes *raw, uint64_t *number) {
    bool there;
    unsigned char bytes[8] = {0};
    raw->size = 0;
    TRY(take_if(trajectory, frame, chunk, 1, raw, &there));
    if (there)
        memcpy(bytes, raw->data, raw->size);
    *number = there ? binary_long(bytes, false) : usual;
    return STATUS_OK;
}

/// What a frame must be like, as numbers of its own and of frame 0.
static enum status check_frame(struct trajectory *trajectory, uint64_t frame, struct bytes *raw) {
    struct gsd *const gsd = trajectory->state;
    const struct source *const source = &trajectory->source;
    uint64_t dimensions, atoms;
    TRY(take_number(trajectory, frame, DIMENSIONS, 3, raw, &dimensions));
    TRY(take_number(trajectory, frame, COUNT, 0, raw, &atoms));
    if (dimensions != 3)
        return mf_source_fail_byte(source, "it is of %llu dimensions; those of 3 are read",
                                   (unsigned long long)dimensions);
    if (atoms == 0)
        return mf_source_fail_byte(source, "there are no particles");
    if (frame > 0 && atoms != gsd->atoms)
        return mf_source_fail_byte(source, "it has %llu particles, the first frame %lu",
                                   (unsigned long long)atoms, (unsigned long)gsd->atoms);
    gsd->atoms = (uint32_t)atoms;
    return STATUS_OK;
}

/// Particles keep their types, which beads are made by.
static enum status check_types(struct trajectory *trajectory, uint64_t frame, struct bytes *raw) {
    struct gsd *const gsd = trajectory->state;
    bool there;
    if (frame > 0 && find(gsd, frame, TYPE) == NULL)
        return STATUS_OK;
    raw->size = 0;
    TRY(take_if(trajectory, frame, TYPE, gsd->atoms, frame > 0 ? raw : &gsd->types, &there));
    if (frame > 0 && there)
        for (size_t k = 0; k < gsd->atoms; k++)
            if (memcmp(raw->data + 4 * k,
                       gsd->types.size ? gsd->types.data + 4 * k
                                       : (const unsigned char *)"\0\0\0\0",
                       4) != 0)
                return mf_source_fail_byte(&trajectory->source,
                                           "particle %zu is of another type than in the first "
                                           "frame",
                                           k + 1);
    return STATUS_OK;
}

static enum status take_box(struct trajectory *trajectory, uint64_t frame, struct bytes *raw,
                            double box[6]) {
    bool there;
    raw->size = 0;
    TRY(take_if(trajectory, frame, BOX, 6, raw, &there));
    for (size_t k = 0; k < 6; k++)
        box[k] = there ? binary_float(raw->data + 4 * k, false) : k < 3;
    return STATUS_OK;
}

static enum status fetch(struct trajectory *trajectory, struct trajectory_frame *frame,
                         bool *more) {
    const struct gsd *const gsd = trajectory->state;
    struct bytes *const raw = &frame->raw;
    const uint64_t number = trajectory->source.frame;
    struct header header = {0};
    bool there;
    (void)more;
    TRY(check_frame(trajectory, number, raw));
    TRY(check_types(trajectory, number, raw));
    TRY(take_number(trajectory, number, STEP, 0, raw, &header.step));
    TRY(take_box(trajectory, number, raw, header.box));
    raw->size = 0;
    TRY(mf_source_capacity(raw, sizeof header));
    raw->size = sizeof header;
    TRY(take_if(trajectory, number, POSITION, gsd->atoms, raw, &there));
    if (!there)
        return mf_source_fail_byte(&trajectory->source, "there are no positions");
    if (gsd->moves && find(gsd, number, VELOCITY))
        TRY(take_if(trajectory, number, VELOCITY, gsd->atoms, raw, &header.has_velocities));
    TRY(take_if(trajectory, number, IMAGE, gsd->atoms, raw, &header.has_images));
    memcpy(raw->data, &header, sizeof header);
    return STATUS_OK;
}

// What the atoms are ------------------------------------------------------------------------------

/// Names of types, each ended by a NUL or by the end of its row; "A" if there are none.
static enum status describe_types(struct trajectory *trajectory, struct bytes *raw) {
    const struct gsd *const gsd = trajectory->state;
    struct structure *const structure = &trajectory->structure;
    uint64_t types;
    uint32_t width = 0;
    raw->size = 0;
    TRY(take(trajectory, 0, TYPES, 0, raw, &types, &width));
    structure->has_names = true; // whose numbers are the file's own
    for (size_t k = 0; k < structure->atoms; k++) {
        struct structure_atom *const atom = &structure->atom[k];
        const uint32_t type = gsd->types.size ? binary_word(gsd->types.data + 4 * k, false) : 0;
        if (type >= (types ? types : 1))
            return mf_source_fail_byte(&trajectory->source, "particle %zu is of type %lu of %llu",
                                       k + 1, (unsigned long)type, (unsigned long long)types);
        const char *const name = types ? (const char *)raw->data + (size_t)type * width : "A";
        const size_t length = types ? strnlen(name, width) : 1;
        memcpy(atom->name, name, length < STRUCTURE_NAME ? length : STRUCTURE_NAME - 1);
    }
    return STATUS_OK;
}

static enum status describe_masses(struct trajectory *trajectory, struct bytes *raw) {
    struct structure *const structure = &trajectory->structure;
    bool there;
    raw->size = 0;
    TRY(take_if(trajectory, 0, MASS, structure->atoms, raw, &there));
    structure->has_masses = true;
    for (size_t k = 0; k < structure->atoms; k++)
        structure->atom[k].mass =
            trajectory->scale.mass * (there ? binary_float(raw->data + 4 * k, false) : 1);
    return STATUS_OK;
}

/// A particle on its own is a bead that is called as its type.
static void name_single(struct structure *structure) {
    for (size_t k = 0; k < structure->atoms; k++)
        if (structure->atom[k].molecule == 0)
            memcpy(structure->atom[k].residue_name, structure->atom[k].name, STRUCTURE_NAME);
}

/// Molecules are what bonds and constraints join.
static enum status describe_molecules(struct trajectory *trajectory, struct bytes *raw) {
    bool there;
    raw->size = 0;
    TRY(take_if(trajectory, 0, BOND, 0, raw, &there));
    TRY(take_if(trajectory, 0, CONSTRAINT, 0, raw, &there));
    const enum status status =
        raw->size == 0 ? STATUS_OK
                       : mf_structure_join(&trajectory->structure,
                                           (const uint32_t(*)[2])(const void *)raw->data,
                                           raw->size / (2 * sizeof(uint32_t)));
    name_single(&trajectory->structure);
    return status == STATUS_BAD_INPUT ? mf_status_prefix(status, "%s", trajectory->file) : status;
}

static enum status describe(struct trajectory *trajectory, struct trajectory_frame *first) {
    const struct gsd *const gsd = trajectory->state;
    struct bytes raw = {0};
    (void)first;
    enum status status = mf_structure_init(&trajectory->structure, gsd->atoms);
    if (status == STATUS_OK)
        status = describe_types(trajectory, &raw);
    if (status == STATUS_OK)
        status = describe_masses(trajectory, &raw);
    if (status == STATUS_OK)
        status = describe_molecules(trajectory, &raw);
    mf_source_free(&raw);
    return status;
}

static enum status decode(const struct trajectory *trajectory, struct trajectory_frame *frame) {
    const size_t atoms = trajectory->structure.atoms, bytes = 12 * atoms;
    const struct trajectory_scale *const scale = &trajectory->scale;
    const unsigned char *const position = frame->raw.data + sizeof(struct header);
    struct header header;
    memcpy(&header, frame->raw.data, sizeof header);
    const double *const v = header.box, x = scale->length;
    const double box[3][3] = {{v[0] * x, 0, 0},
                              {v[3] * v[1] * x, v[1] * x, 0},
                              {v[4] * v[2] * x, v[5] * v[2] * x, v[2] * x}};
    const unsigned char *const velocity = position + bytes, *const image =
                                                                velocity +
                                                                (header.has_velocities ? bytes : 0);
    frame->step = header.step < INT64_MAX ? (int64_t)header.step : -1;
    mf_frame_set_box(frame, box);
    TRY(mf_frame_reserve(frame, atoms, header.has_velocities));
    for (size_t k = 0; k < 3 * atoms; k++) {
        const size_t at = 4 * k;
        frame->position[k / 3][k % 3] = x * binary_float(position + at, false);
        for (size_t i = 0; header.has_images && i < 3; i++)
            frame->position[k / 3][k % 3] +=
                frame->box[i][k % 3] * binary_int(image + 12 * (k / 3) + 4 * i, false);
        if (header.has_velocities)
            frame->velocity[k / 3][k % 3] = scale->speed * binary_float(velocity + at, false);
        if (!isfinite(frame->position[k / 3][k % 3]) ||
            (header.has_velocities && !isfinite(frame->velocity[k / 3][k % 3])))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: frame %zu: position or velocity of particle %zu is not "
                                  "finite",
                                  frame->file, frame->number, k / 3 + 1);
    }
    return STATUS_OK;
}

static const char *const extensions[] = {"gsd", NULL};

const struct trajectory_format mf_format_gsd = {
    .name = "gsd",
    .extensions = extensions,
    .summary = "HOOMD-blue: positions, velocities, images, box; types, masses, molecules by bonds",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .state_size = sizeof(struct gsd),
    .recognise = recognise,
    .open = open_file,
    .close = close_file,
    .fetch = fetch,
    .describe = describe,
    .decode = decode,
};
