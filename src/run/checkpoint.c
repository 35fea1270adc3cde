// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/checkpoint.h"

#include "io/output.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

static const char magic[16] = "mesofit state 1";

enum status checkpoint_save(const char *file, uint64_t digest, const struct memory_span *spans,
                            size_t count) {
    struct output output;
    TRY(output_open(&output, file));
    // Write errors are remembered by the stream and found by output_commit.
    fwrite(magic, sizeof magic, 1, output.stream);
    fwrite(&digest, sizeof digest, 1, output.stream);
    for (size_t k = 0; k < count; k++) {
        const uint64_t bytes = spans[k].bytes;
        fwrite(&bytes, sizeof bytes, 1, output.stream);
        fwrite(spans[k].memory, 1, spans[k].bytes, output.stream);
    }
    return output_commit(&output);
}

static bool read_exactly(FILE *stream, void *memory, size_t bytes) {
    return fread(memory, 1, bytes, stream) == bytes;
}

/// A file can be positioned beyond its end: the last byte has to be read.
static bool skip_exactly(FILE *stream, uint64_t bytes) {
    return bytes == 0 || (fseek(stream, (long)bytes - 1, SEEK_CUR) == 0 && fgetc(stream) != EOF);
}

static enum status read_head(FILE *stream, const char *file, uint64_t digest) {
    char found_magic[sizeof magic];
    uint64_t found_digest;
    if (!read_exactly(stream, found_magic, sizeof found_magic) ||
        memcmp(found_magic, magic, sizeof magic) != 0 ||
        !read_exactly(stream, &found_digest, sizeof found_digest))
        return status_fail(STATUS_BAD_INPUT, "%s: not a checkpoint of this version", file);
    if (found_digest != digest)
        return status_fail(STATUS_BAD_INPUT,
                           "%s: the run's settings have changed since it was written; start anew "
                           "without --resume",
                           file);
    return STATUS_OK;
}

static enum status fail_shape(const char *file) {
    return status_fail(STATUS_BAD_INPUT, "%s: the checkpoint is of another shape", file);
}

/// Read through the file once, into the spans or, with `load` false, only checking lengths.
static enum status walk(FILE *stream, const char *file, uint64_t digest,
                        const struct memory_span *spans, size_t count, bool load) {
    uint64_t bytes;
    TRY(read_head(stream, file, digest));
    for (size_t k = 0; k < count; k++) {
        const bool fits =
            read_exactly(stream, &bytes, sizeof bytes) && bytes == spans[k].bytes &&
            (load ? read_exactly(stream, spans[k].memory, bytes) : skip_exactly(stream, bytes));
        if (!fits)
            return fail_shape(file);
    }
    return fgetc(stream) == EOF ? STATUS_OK : fail_shape(file);
}

static enum status read_span(FILE *stream, const char *file, size_t number,
                             const struct memory_span *span) {
    uint64_t bytes;
    for (size_t k = 0; k < number; k++)
        if (!read_exactly(stream, &bytes, sizeof bytes) || !skip_exactly(stream, bytes))
            return fail_shape(file);
    const bool fits = read_exactly(stream, &bytes, sizeof bytes) && bytes == span->bytes &&
                      read_exactly(stream, span->memory, bytes);
    return fits ? STATUS_OK : fail_shape(file);
}

static enum status open_file(FILE **stream, const char *file) {
    *stream = fopen(file, "rb");
    return *stream ? STATUS_OK : status_fail(STATUS_IO, "%s: %s", file, strerror(errno));
}

enum status checkpoint_load_span(const char *file, uint64_t digest, size_t number,
                                 const struct memory_span *span) {
    FILE *stream;
    TRY(open_file(&stream, file));
    enum status status = read_head(stream, file, digest);
    if (status == STATUS_OK)
        status = read_span(stream, file, number, span);
    fclose(stream);
    return status;
}

enum status checkpoint_load(const char *file, uint64_t digest, const struct memory_span *spans,
                            size_t count) {
    FILE *stream;
    TRY(open_file(&stream, file));
    enum status status = walk(stream, file, digest, spans, count, false);
    if (status == STATUS_OK) {
        rewind(stream);
        status = walk(stream, file, digest, spans, count, true);
    }
    fclose(stream);
    return status;
}

void checkpoint_digest_add(uint64_t *digest, const void *memory, size_t bytes) {
    const unsigned char *byte = memory;
    for (size_t k = 0; memory && k < bytes; k++)
        *digest = (*digest ^ byte[k]) * 0x100000001b3u;
}

enum status checkpoint_digest(const char *file, uint64_t *digest) {
    FILE *stream;
    unsigned char piece[4096];
    size_t bytes;
    TRY(open_file(&stream, file));
    *digest = 0xcbf29ce484222325u;
    while ((bytes = fread(piece, 1, sizeof piece, stream)) > 0)
        checkpoint_digest_add(digest, piece, bytes);
    fclose(stream);
    return STATUS_OK;
}
