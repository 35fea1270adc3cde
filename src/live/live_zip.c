// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_zip.h"

#include "base/memory.h"
#include "live/live_folder.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_MEMBERS = 4096, DEEPEST = 3, LARGEST = 256 << 20 };

struct member {
    char *name;
    uint32_t check, size, offset;
};

struct zip {
    FILE *stream;
    uint32_t table[256]; ///< of the CRC-32
    uint32_t written;
    size_t count;
    struct member member[MAX_MEMBERS];
};

/// CRC-32 of ISO 3309, polynomial 0xEDB88320 reflected, as zip wants it.
static void make_table(uint32_t table[256]) {
    for (uint32_t k = 0; k < 256; k++) {
        table[k] = k;
        for (int bit = 0; bit < 8; bit++)
            table[k] = table[k] & 1 ? 0xEDB88320u ^ (table[k] >> 1) : table[k] >> 1;
    }
}

static uint32_t find_check(const uint32_t table[256], const unsigned char *bytes, size_t size) {
    uint32_t check = 0xFFFFFFFFu;
    for (size_t k = 0; k < size; k++)
        check = table[(check ^ bytes[k]) & 255] ^ (check >> 8);
    return ~check;
}

/// A number of `bytes` bytes, the lowest first.
static void append(struct zip *zip, uint32_t number, int bytes) {
    for (int k = 0; k < bytes; k++)
        fputc((int)(number >> (8 * k) & 255), zip->stream);
    zip->written += (uint32_t)bytes;
}

static void write_bytes(struct zip *zip, const void *bytes, size_t size) {
    fwrite(bytes, 1, size, zip->stream);
    zip->written += (uint32_t)size;
}

/// What local and central headers share: version 2.0, names in UTF-8, stored, 1 January 1980.
static void write_header(struct zip *zip, const struct member *member) {
    append(zip, 20, 2);
    append(zip, 1 << 11, 2);
    append(zip, 0, 2);
    append(zip, 0, 2);
    append(zip, 33, 2);
    append(zip, member->check, 4);
    append(zip, member->size, 4);
    append(zip, member->size, 4);
    append(zip, (uint32_t)strlen(member->name), 2);
    append(zip, 0, 2);
}

static enum status read_whole(int file, unsigned char *bytes, size_t size, const char *name) {
    for (size_t got = 0; got < size;) {
        const ssize_t more = read(file, bytes + got, size - got);
        if (more < 0 && errno == EINTR)
            continue;
        if (more <= 0)
            return mf_status_fail(STATUS_IO, "%.200s: %s", name,
                                  more < 0 ? strerror(errno) : "it became shorter");
        got += (size_t)more;
    }
    return STATUS_OK;
}

static enum status add(void *context, int file, size_t size, const char *name) {
    struct zip *zip = context;
    OWNED unsigned char *bytes = NULL;
    if (zip->count == MAX_MEMBERS || zip->written > LARGEST || size > LARGEST - zip->written)
        return mf_status_fail(STATUS_BAD_INPUT, "the folder is too large to be downloaded");
    TRY_ARRAY(bytes, size + 1);
    TRY(read_whole(file, bytes, size, name));
    struct member *member = &zip->member[zip->count];
    *member = (struct member){strdup(name), find_check(zip->table, bytes, size), (uint32_t)size,
                              zip->written};
    TRY(member->name ? STATUS_OK : STATUS_NO_MEMORY);
    zip->count++;
    append(zip, 0x04034b50, 4);
    write_header(zip, member);
    write_bytes(zip, member->name, strlen(member->name));
    write_bytes(zip, bytes, size);
    return STATUS_OK;
}

static void write_directory(struct zip *zip) {
    const uint32_t begin = zip->written;
    for (size_t k = 0; k < zip->count; k++) {
        const struct member *member = &zip->member[k];
        append(zip, 0x02014b50, 4);
        append(zip, 20, 2);
        write_header(zip, member);
        append(zip, 0, 2);
        append(zip, 0, 2);
        append(zip, 0, 2);
        append(zip, 0, 4);
        append(zip, member->offset, 4);
        write_bytes(zip, member->name, strlen(member->name));
    }
    const uint32_t size = zip->written - begin;
    append(zip, 0x06054b50, 4);
    append(zip, 0, 4);
    append(zip, (uint32_t)zip->count, 2);
    append(zip, (uint32_t)zip->count, 2);
    append(zip, size, 4);
    append(zip, begin, 4);
    append(zip, 0, 2);
}

enum status mf_live_zip_write(int root, const char *path, FILE *stream) {
    enum status status = STATUS_OK;
    struct zip *zip = NULL;
    NEW_ARRAY(zip, 1);
    zip->stream = stream;
    make_table(zip->table);
    CHECK(mf_live_folder_each(root, path, DEEPEST, add, zip));
    write_directory(zip);
    if (ferror(stream))
        status = mf_status_fail(STATUS_IO, "%.200s: %s", path, strerror(errno));
done:
    for (size_t k = 0; zip && k < zip->count; k++)
        free(zip->member[k].name);
    mf_memory_free(zip);
    return status;
}
