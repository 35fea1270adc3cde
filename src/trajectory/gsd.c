// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/gsd.h"

#include "trajectory/binary.h"

#include <string.h>

/// Bytes of the head of a file and of an entry of its index.
enum { LARGEST_VERSION = 2, HEAD = 256, ENTRY = 32 };

/// Numbers as the file layer has them.
enum type {
    UINT8 = 1,
    UINT16,
    UINT32,
    UINT64,
    INT8,
    INT16,
    INT32,
    INT64,
    FLOAT,
    DOUBLE,
    CHARACTER,
    TYPES_END
};
static const unsigned char stored_bytes[TYPES_END] = {
    [UINT8] = 1, [UINT16] = 2, [UINT32] = 4, [UINT64] = 8, [INT8] = 1,      [INT16] = 2,
    [INT32] = 4, [INT64] = 8,  [FLOAT] = 4,  [DOUBLE] = 8, [CHARACTER] = 1,
};

/// What a chunk holds. Programs and their versions write it in numbers of several widths and signs
/// (HOOMD-blue 7 floats of 8 bytes, names as bytes with or without a sign); we keep one of each.
enum holds { TEXT, WHOLE, STEPS, REAL };
static const size_t kept_bytes[] = {[TEXT] = 1, [WHOLE] = 4, [STEPS] = 8, [REAL] = 8};

/// `type` is what we write; names are read of any width.
static const struct {
    const char *name;
    enum holds holds;
    enum type type;
    size_t columns;
} chunks[CHUNKS] = {
    [STEP] = {"configuration/step", STEPS, UINT64, 1},
    [DIMENSIONS] = {"configuration/dimensions", WHOLE, UINT8, 1},
    [BOX] = {"configuration/box", REAL, FLOAT, 1},
    [COUNT] = {"particles/N", WHOLE, UINT32, 1},
    [TYPES] = {"particles/types", TEXT, INT8, GSD_NAME},
    [TYPE] = {"particles/typeid", WHOLE, UINT32, 1},
    [MASS] = {"particles/mass", REAL, FLOAT, 1},
    [POSITION] = {"particles/position", REAL, FLOAT, 3},
    [VELOCITY] = {"particles/velocity", REAL, FLOAT, 3},
    [IMAGE] = {"particles/image", WHOLE, INT32, 3},
    [BONDS] = {"bonds/N", WHOLE, UINT32, 1},
    [BOND] = {"bonds/group", WHOLE, UINT32, 2},
    [ANGLE] = {"angles/group", WHOLE, UINT32, 3},
    [DIHEDRAL] = {"dihedrals/group", WHOLE, UINT32, 4},
    [BOND_TYPE] = {"bonds/typeid", WHOLE, UINT32, 1},
    [ANGLE_TYPE] = {"angles/typeid", WHOLE, UINT32, 1},
    [DIHEDRAL_TYPE] = {"dihedrals/typeid", WHOLE, UINT32, 1},
    [BOND_TYPES] = {"bonds/types", TEXT, INT8, GSD_NAME},
    [ANGLE_TYPES] = {"angles/types", TEXT, INT8, GSD_NAME},
    [DIHEDRAL_TYPES] = {"dihedrals/types", TEXT, INT8, GSD_NAME},
    [CONSTRAINT] = {"constraints/group", WHOLE, UINT32, 2},
};

const char *mf_gsd_name(enum gsd_chunk chunk) {
    return chunks[chunk].name;
}

// The file ----------------------------------------------------------------------------------------

static const unsigned char *entry(const struct gsd *gsd, size_t k) {
    return gsd->index.data + k * ENTRY;
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
    const size_t all = gsd->index.size / ENTRY;
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
    TRY(mf_source_take(source, head, HEAD));
    const unsigned char *const at = head->data;
    const unsigned version = binary_word(at + 44, false) >> 16;
    if (version > LARGEST_VERSION)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: GSD of version %u; 1 and 2 are read",
                              trajectory->file, version);
    if (strncmp((const char *)at + 112, "hoomd", GSD_NAME) != 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: GSD of the schema \"%.63s\"; hoomd is read",
                              trajectory->file, (const char *)at + 112);
    TRY(take_at(source, &gsd->index, binary_long(at + 8, false), binary_long(at + 16, false),
                ENTRY));
    TRY(take_at(source, names, binary_long(at + 24, false), binary_long(at + 32, false), GSD_NAME));
    find_names(gsd, names, version);
    return check_index(trajectory);
}

enum status mf_gsd_open(struct trajectory *trajectory) {
    struct gsd *const gsd = trajectory->state;
    struct bytes head = {0}, names = {0};
    for (int k = 0; k < CHUNKS; k++)
        gsd->id[k] = -1;
    const enum status status = read_head(trajectory, &head, &names);
    mf_source_free(&head);
    mf_source_free(&names);
    return status;
}

void mf_gsd_close(struct trajectory *trajectory) {
    struct gsd *const gsd = trajectory->state;
    mf_source_free(&gsd->index);
    mf_source_free(&gsd->types);
}

// Chunks ------------------------------------------------------------------------------------------

const unsigned char *mf_gsd_find(const struct gsd *gsd, uint64_t frame, enum gsd_chunk chunk) {
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

/// Bytes of a number of a type; 0 if it cannot be what a chunk holds.
static size_t bytes_of(unsigned type, enum holds holds) {
    const bool real = type == FLOAT || type == DOUBLE;
    const size_t bytes = type < TYPES_END ? stored_bytes[type] : 0;
    return real != (holds == REAL) || (holds == TEXT && bytes != 1) ? 0 : bytes;
}

static int64_t stored_integer(const unsigned char *at, enum type type, size_t bytes) {
    uint64_t bits = 0;
    for (size_t k = bytes; k-- > 0;)
        bits = bits << 8 | at[k];
    const uint64_t sign = type >= INT8 && bytes < 8 ? (uint64_t)1 << (8 * bytes - 1) : 0;
    return (int64_t)((bits ^ sign) - sign);
}

/// One number as it is kept. @return whether it fits
static bool keep_number(unsigned char *to, const unsigned char *from, enum type type, size_t bytes,
                        enum holds holds) {
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
static enum status keep(struct source *source, enum gsd_chunk chunk, enum type type, size_t bytes,
                        struct bytes *raw, size_t from) {
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

enum status mf_gsd_take(struct trajectory *trajectory, uint64_t frame, enum gsd_chunk chunk,
                        uint64_t rows, struct bytes *raw, uint64_t *rows_found,
                        uint32_t *columns_found) {
    const struct gsd *const gsd = trajectory->state;
    struct source *const source = &trajectory->source;
    const size_t from = raw->size;
    const unsigned char *at = mf_gsd_find(gsd, frame, chunk);
    at = at ? at : mf_gsd_find(gsd, 0, chunk);
    *rows_found = at ? binary_long(at + 8, false) : 0;
    if (*rows_found == 0)
        return STATUS_OK;
    const uint32_t columns = binary_word(at + 24, false);
    const size_t bytes = bytes_of(at[30], chunks[chunk].holds);
    if (bytes == 0 || (rows > 0 && *rows_found != rows) || columns == 0 ||
        (chunks[chunk].holds != TEXT && columns != chunks[chunk].columns))
        return mf_source_fail_byte(source,
                                   "\"%s\" has %llu rows of %lu numbers of type %d, which it "
                                   "cannot have",
                                   chunks[chunk].name, (unsigned long long)*rows_found,
                                   (unsigned long)columns, at[30]);
    *columns_found = columns;
    TRY(take_at(source, raw, binary_long(at + 16, false), *rows_found, (uint64_t)columns * bytes));
    return keep(source, chunk, at[30], bytes, raw, from);
}

enum status mf_gsd_take_if(struct trajectory *trajectory, uint64_t frame, enum gsd_chunk chunk,
                           uint64_t rows, struct bytes *raw, bool *there) {
    uint64_t found;
    uint32_t columns;
    TRY(mf_gsd_take(trajectory, frame, chunk, rows, raw, &found, &columns));
    *there = found > 0;
    return STATUS_OK;
}

enum status mf_gsd_take_number(struct trajectory *trajectory, uint64_t frame, enum gsd_chunk chunk,
                               uint64_t usual, struct bytes *raw, uint64_t *number) {
    bool there;
    unsigned char bytes[8] = {0};
    raw->size = 0;
    TRY(mf_gsd_take_if(trajectory, frame, chunk, 1, raw, &there));
    if (there)
        memcpy(bytes, raw->data, raw->size);
    *number = there ? binary_long(bytes, false) : usual;
    return STATUS_OK;
}

// Writing -----------------------------------------------------------------------------------------

static void put_text(const char *text, size_t width, FILE *stream) {
    for (size_t k = 0, length = strlen(text); k < width; k++)
        putc(k < length ? text[k] : '\0', stream);
}

void mf_gsd_put(enum gsd_chunk chunk, int64_t number, FILE *stream) {
    binary_put(stream, (uint64_t)number, stored_bytes[chunks[chunk].type], false);
}

void mf_gsd_put_real(double number, FILE *stream) {
    binary_put_float(stream, number, false);
}

void mf_gsd_put_name(const char *name, FILE *stream) {
    put_text(name, GSD_NAME, stream);
}

static void put_head(uint64_t index, uint64_t entries, uint64_t names, FILE *stream) {
    binary_put(stream, 0x65DF65DF65DF65DF, 8, false);
    binary_put(stream, index, 8, false);
    binary_put(stream, entries, 8, false);
    binary_put(stream, HEAD, 8, false);  // where names are
    binary_put(stream, names, 8, false); // of up to 64 bytes each
    binary_put(stream, 1 << 16 | 4, 4, false);
    binary_put(stream, 2 << 16, 4, false);
    put_text("mesofit", GSD_NAME, stream);
    put_text("hoomd", GSD_NAME, stream);
    put_text("", HEAD - 2 * GSD_NAME - 48, stream);
}

/// Where everything is that is written: the head, the names, an index with room for 16 frames,
/// these, a copy of the index with room for 32, the next 16 frames, one with room for 64, and so
/// on. The last index counts. So a frame costs the same however many there are, and the bytes of a
/// file do not depend on where a run was interrupted.
struct layout {
    uint64_t id[CHUNKS], names;
    uint64_t entries[2], bytes[2]; ///< of the first frame, and of each other one
};

enum { FIRST_ROOM = 16 };

static uint64_t chunk_bytes(const struct gsd_content *content, int chunk, size_t frame) {
    return content->rows(content->context, (enum gsd_chunk)chunk, frame) * chunks[chunk].columns *
           stored_bytes[chunks[chunk].type];
}

static struct layout find_layout(const struct gsd_content *content) {
    struct layout layout = {0};
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        for (size_t frame = 0; frame < 2; frame++) {
            const uint64_t bytes = chunk_bytes(content, chunk, frame);
            layout.bytes[frame] += bytes;
            layout.entries[frame] += bytes > 0;
            if (frame == 0)
                layout.id[chunk] = layout.names;
            if (frame == 0 && bytes > 0)
                layout.names++;
        }
    return layout;
}

/// Sum over so many frames.
static uint64_t sum_of(const uint64_t of_frame[2], size_t frames) {
    return frames == 0 ? 0 : of_frame[0] + (frames - 1) * of_frame[1];
}

/// Frames that the index has room for which a frame is written in.
static size_t room_of(size_t frame) {
    size_t room = FIRST_ROOM;
    while (room <= frame)
        room *= 2;
    return room;
}

/// Where a frame would begin if those with this much room were the last index before it.
static uint64_t find_place(const struct layout *layout, size_t frame, size_t room) {
    uint64_t place = HEAD + layout->names * GSD_NAME + sum_of(layout->bytes, frame);
    for (size_t before = FIRST_ROOM; before <= room; before *= 2)
        place += ENTRY * sum_of(layout->entries, before);
    return place;
}

static uint64_t find_index(const struct layout *layout, size_t room) {
    return find_place(layout, room > FIRST_ROOM ? room / 2 : 0, room / 2);
}

static void seek(uint64_t place, FILE *stream) {
    (void)fseeko(stream, (off_t)place, SEEK_SET); // a stream that cannot has an error
}

/// Entries of a frame, sorted by ids.
static void put_entries(const struct gsd_content *content, const struct layout *layout,
                        size_t frame, FILE *stream) {
    uint64_t at = find_place(layout, frame, room_of(frame));
    for (int chunk = 0; chunk < CHUNKS; chunk++) {
        const uint64_t rows = content->rows(content->context, (enum gsd_chunk)chunk, frame);
        if (rows == 0)
            continue;
        binary_put(stream, frame, 8, false);
        binary_put(stream, rows, 8, false);
        binary_put(stream, at, 8, false);
        binary_put(stream, chunks[chunk].columns, 4, false);
        binary_put(stream, layout->id[chunk], 2, false);
        binary_put(stream, chunks[chunk].type, 1, false);
        binary_put(stream, 0, 1, false);
        at += chunk_bytes(content, chunk, frame);
    }
}

static void put_names(const struct gsd_content *content, const struct layout *layout,
                      FILE *stream) {
    size_t length = 0;
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        if (content->rows(content->context, (enum gsd_chunk)chunk, 0) > 0) {
            put_text(chunks[chunk].name, strlen(chunks[chunk].name) + 1, stream);
            length += strlen(chunks[chunk].name) + 1;
        }
    put_text("", layout->names * GSD_NAME - length, stream);
}

static void put_head_of(const struct layout *layout, size_t room, FILE *stream) {
    seek(0, stream);
    put_head(find_index(layout, room), sum_of(layout->entries, room), layout->names, stream);
}

void mf_gsd_put_frame(const struct gsd_content *content, size_t frame, FILE *stream) {
    const struct layout layout = find_layout(content);
    const size_t room = room_of(frame);
    const bool is_new = frame == 0 || room_of(frame - 1) < room;
    if (frame == 0) {
        put_text("", HEAD, stream);
        put_names(content, &layout, stream);
    }
    for (size_t before = 0; is_new && before < frame; before++)
        put_entries(content, &layout, before, stream);
    if (is_new)
        put_text("", ENTRY * (sum_of(layout.entries, room) - sum_of(layout.entries, frame)),
                 stream);
    for (int chunk = 0; chunk < CHUNKS; chunk++)
        if (content->rows(content->context, (enum gsd_chunk)chunk, frame) > 0)
            content->put(content->context, (enum gsd_chunk)chunk, stream);
    seek(find_index(&layout, room) + ENTRY * sum_of(layout.entries, frame), stream);
    put_entries(content, &layout, frame, stream);
    if (is_new)
        put_head_of(&layout, room, stream);
    seek(find_place(&layout, frame + 1, room), stream);
}

void mf_gsd_cut(const struct gsd_content *content, size_t frames, FILE *stream) {
    const struct layout layout = find_layout(content);
    if (frames == 0)
        return;
    const size_t room = room_of(frames - 1);
    const uint64_t used = sum_of(layout.entries, frames);
    seek(find_index(&layout, room) + ENTRY * used, stream);
    put_text("", ENTRY * (sum_of(layout.entries, room) - used), stream);
    put_head_of(&layout, room, stream);
}
