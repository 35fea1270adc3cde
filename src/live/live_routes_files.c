// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests about files: list, read, write, download.
#include "base/memory.h"
#include "live/live_folder.h"
#include "live/live_routes.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// A folder as one zip file ------------------------------------------------------------------------

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

/// Types of what a browser shows; the rest is text.
static const struct {
    const char *end, *type;
} types[] = {{".json", "application/json"},
             {".png", "image/png"},
             {".svg", "image/svg+xml"},
             {".bin", "application/octet-stream"}};

static const char *find_type(const char *path) {
    const char *end = strrchr(path, '.');
    for (size_t k = 0; end && k < sizeof types / sizeof *types; k++)
        if (strcmp(end, types[k].end) == 0)
            return types[k].type;
    return "text/plain; charset=utf-8";
}

/// The path of a request, "" without one.
static const char *find_path(const struct live_request *request) {
    const char *path = mf_live_server_argument(request, "path");
    return path ? path : "";
}

static int find_root(struct live_view *view, const struct live_request *request) {
    return mf_live_view_root(view, mf_live_server_argument(request, "in"));
}

/// What is written about a path into a stream, in memory: `bytes` is to be freed with free().
static enum status collect(struct live_view *view, const struct live_request *request,
                           enum status (*write)(int root, const char *path, FILE *stream),
                           char **bytes, size_t *size) {
    const int root = find_root(view, request);
    if (root < 0)
        return STATUS_IO;
    FILE *stream = open_memstream(bytes, size);
    enum status status = stream ? write(root, find_path(request), stream)
                                : mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    close(root);
    if (stream && fclose(stream) != 0 && status == STATUS_OK)
        status = mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    if (status != STATUS_OK) {
        free(*bytes);
        *bytes = NULL;
    }
    return status;
}

static enum status list(struct live_view *view, const struct live_request *request,
                        struct live_answer *answer) {
    char *text = NULL;
    size_t size;
    TRY(collect(view, request, mf_live_folder_list, &text, &size));
    return mf_live_routes_give(answer, "application/json", text);
}

static enum status read_file(struct live_view *view, const struct live_request *request,
                             struct live_answer *answer) {
    const char *path = find_path(request);
    const int root = find_root(view, request);
    if (root < 0)
        return STATUS_IO;
    answer->file = mf_live_folder_read(root, path, &answer->size);
    close(root);
    if (answer->file < 0) {
        answer->file = 0;
        return STATUS_IO;
    }
    answer->type = find_type(path);
    return STATUS_OK;
}

/// Into the working folder alone: results are the program's.
static enum status write_file(struct live_view *view, const struct live_request *request,
                              struct live_answer *answer) {
    const char *replace = mf_live_server_argument(request, "replace");
    const int root = mf_live_view_root(view, NULL);
    if (root < 0)
        return STATUS_IO;
    const enum status status =
        mf_live_folder_write(root, find_path(request), request->body, request->size,
                             replace && strcmp(replace, "1") == 0);
    close(root);
    TRY(status);
    return mf_live_routes_give(answer, NULL, strdup("written"));
}

static enum status zip(struct live_view *view, const struct live_request *request,
                       struct live_answer *answer) {
    char *bytes = NULL;
    TRY(collect(view, request, mf_live_zip_write, &bytes, &answer->size));
    answer->type = "application/zip";
    answer->name = "results.zip";
    answer->bytes = bytes;
    return STATUS_OK;
}

const struct live_route mf_live_routes_files[] = {
    {"/api/files", false, list},
    {"/api/file", false, read_file},
    {"/api/file", true, write_file},
    {"/api/zip", false, zip},
    {NULL, false, NULL},
};
