// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/gsd_chunks.h"

#include "io/gsd.h"
#include "trajectory/binary.h"

#include <string.h>

enum { LARGEST_VERSION = 2 };

/// What a chunk holds. Programs and their versions write it in numbers of several widths and signs
/// (HOOMD-blue 7 floats of 8 bytes, names as bytes with or without a sign); we keep one of each.
enum holds { TEXT, WHOLE, STEPS, REAL };
static const size_t kept_bytes[] = {[TEXT] = 1, [WHOLE] = 4, [STEPS] = 8, [REAL] = 8};

/// `columns` 0: any number of them.
static const struct {
    const char *name;
    enum holds holds;
    size_t columns;
} chunks[CHUNKS] = {
    [STEP] = {"configuration/step", STEPS, 1},
    [DIMENSIONS] = {"configuration/dimensions", WHOLE, 1},
    [BOX] = {"configuration/box", REAL, 1},
    [COUNT] = {"particles/N", WHOLE, 1},
    [TYPES] = {"particles/types", TEXT, 0},
    [TYPE] = {"particles/typeid", WHOLE, 1},
    [MASS] = {"particles/mass", REAL, 1},
    [POSITION] = {"particles/position", REAL, 3},
    [VELOCITY] = {"particles/velocity", REAL, 3},
    [IMAGE] = {"particles/image", WHOLE, 3},
    [BOND] = {"bonds/group", WHOLE, 2},
    [ANGLE] = {"angles/group", WHOLE, 3},
    [DIHEDRAL] = {"dihedrals/group", WHOLE, 4},
    [BOND_TYPE] = {"bonds/typeid", WHOLE, 1},
    [ANGLE_TYPE] = {"angles/typeid", WHOLE, 1},
    [DIHEDRAL_TYPE] = {"dihedrals/typeid", WHOLE, 1},
    [BOND_TYPES] = {"bonds/types", TEXT, 0},
    [ANGLE_TYPES] = {"angles/types", TEXT, 0},
    [DIHEDRAL_TYPES] = {"dihedrals/types", TEXT, 0},
    [CONSTRAINT] = {"constraints/group", WHOLE, 2},
};

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

enum status mf_gsd_chunks_open(struct trajectory *trajectory) {
    struct gsd *const gsd = trajectory->state;
    struct bytes head = {0}, names = {0};
    for (int k = 0; k < CHUNKS; k++)
        gsd->id[k] = -1;
    const enum status status = read_head(trajectory, &head, &names);
    mf_source_free(&head);
    mf_source_free(&names);
    return status;
}

void mf_gsd_chunks_close(struct trajectory *trajectory) {
    struct gsd *const gsd = trajectory->state;
    mf_source_free(&gsd->index);
    mf_source_free(&gsd->types);
}

// Chunks ------------------------------------------------------------------------------------------

const unsigned char *mf_gsd_chunks_find(const struct gsd *gsd, uint64_t frame,
                                        enum gsd_chunk chunk) {
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

/// Bytes of a number of each type of the file layer, and whether it can be what a chunk holds.
static size_t stored_bytes(enum gsd_type type, enum holds holds) {
    static const struct {
        unsigned char bytes;
        bool is_real;
    } types[] = {
        [GSD_UINT8] = {1, false},  [GSD_UINT16] = {2, false},    [GSD_UINT32] = {4, false},
        [GSD_UINT64] = {8, false}, [GSD_INT8] = {1, false},      [GSD_INT16] = {2, false},
        [GSD_INT32] = {4, false},  [GSD_INT64] = {8, false},     [GSD_FLOAT] = {4, true},
        [GSD_DOUBLE] = {8, true},  [GSD_CHARACTER] = {1, false},
    };
    if (type >= sizeof types / sizeof *types || types[type].is_real != (holds == REAL) ||
        (holds == TEXT && types[type].bytes != 1))
        return 0;
    return types[type].bytes;
}

static int64_t stored_integer(const unsigned char *at, enum gsd_type type, size_t bytes) {
    uint64_t bits = 0;
    for (size_t k = bytes; k-- > 0;)
        bits = bits << 8 | at[k];
    const uint64_t sign = type >= GSD_INT8 && bytes < 8 ? (uint64_t)1 << (8 * bytes - 1) : 0;
    return (int64_t)((bits ^ sign) - sign);
}

/// One number as it is kept. @return whether it fits
static bool keep_number(unsigned char *to, const unsigned char *from, enum gsd_type type,
                        size_t bytes, enum holds holds) {
    if (holds == REAL) {
        const double real = binary_real(from, 0, bytes, false);
        memcpy(to, &real, sizeof real);
        return true;
    }
    const int64_t number = stored_integer(from, type, bytes);
    for (size_t k = 0; k < kept_bytes[holds]; k++)
        to[k] = (unsigned char)((uint64_t)number >> 8 * k & 0xFF);
    return holds == STEPS || (number >= INT32_MIN && number <= UINT32_MAX);
}

/// The numbers from byte `from` of `raw` on, where they stand, as they are kept.
static enum status keep(struct source *source, enum gsd_chunk chunk, enum gsd_type type,
                        size_t bytes, struct bytes *raw, size_t from) {
    const enum holds holds = chunks[chunk].holds;
    const size_t count = (raw->size - from) / bytes, kept = kept_bytes[holds];
    bool fit = true;
    if (kept == bytes && holds != REAL)
        return STATUS_OK;
    if (kept > bytes)
        TRY(mf_source_capacity(raw, count * (kept - bytes)));
    unsigned char *const at = raw->data + from;
    for (size_t n = 0; n < count; n++) { // what grows is moved from its end on
        const size_t k = kept > bytes ? count - 1 - n : n;
        fit = keep_number(at + k * kept, at + k * bytes, type, bytes, holds) && fit;
    }
    raw->size = from + count * kept;
    return fit ? STATUS_OK
               : mf_source_fail_byte(source, "\"%s\" has a number beyond 32 bits",
                                     chunks[chunk].name);
}

enum status mf_gsd_chunks_take(struct trajectory *trajectory, uint64_t frame, enum gsd_chunk chunk,
                               uint64_t rows, struct bytes *raw, uint64_t *rows_found,
                               uint32_t *columns_found) {
    const struct gsd *const gsd = trajectory->state;
    struct source *const source = &trajectory->source;
    const size_t from = raw->size;
    const unsigned char *at = mf_gsd_chunks_find(gsd, frame, chunk);
    at = at ? at : mf_gsd_chunks_find(gsd, 0, chunk);
    *rows_found = at ? binary_long(at + 8, false) : 0;
    if (*rows_found == 0)
        return STATUS_OK;
    const uint32_t columns = binary_word(at + 24, false);
    const size_t bytes = stored_bytes(at[30], chunks[chunk].holds);
    if (bytes == 0 || (rows > 0 && *rows_found != rows) || columns == 0 ||
        (chunks[chunk].columns > 0 && columns != chunks[chunk].columns))
        return mf_source_fail_byte(source,
                                   "\"%s\" has %llu rows of %lu numbers of type %d, which it "
                                   "cannot have",
                                   chunks[chunk].name, (unsigned long long)*rows_found,
                                   (unsigned long)columns, at[30]);
    *columns_found = columns;
    TRY(take_at(source, raw, binary_long(at + 16, false), *rows_found, (uint64_t)columns * bytes));
    return keep(source, chunk, at[30], bytes, raw, from);
}

enum status mf_gsd_chunks_take_if(struct trajectory *trajectory, uint64_t frame,
                                  enum gsd_chunk chunk, uint64_t rows, struct bytes *raw,
                                  bool *there) {
    uint64_t found;
    uint32_t columns;
    TRY(mf_gsd_chunks_take(trajectory, frame, chunk, rows, raw, &found, &columns));
    *there = found > 0;
    return STATUS_OK;
}

enum status mf_gsd_chunks_take_number(struct trajectory *trajectory, uint64_t frame,
                                      enum gsd_chunk chunk, uint64_t usual, struct bytes *raw,
                                      uint64_t *number) {
    bool there;
    unsigned char bytes[8] = {0};
    raw->size = 0;
    TRY(mf_gsd_chunks_take_if(trajectory, frame, chunk, 1, raw, &there));
    if (there)
        memcpy(bytes, raw->data, raw->size);
    *number = there ? binary_long(bytes, false) : usual;
    return STATUS_OK;
}

const char *mf_gsd_chunks_name(enum gsd_chunk chunk) {
    return chunks[chunk].name;
}
