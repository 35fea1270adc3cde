// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.h"

#include "base/digest.h"
#include "io/input.h"
#include "io/output.h"

#include <errno.h>
#include <string.h>

static const char magic[16] = "mesofit state 9";

/// Bytes of the file, and their checksum so far.
struct writer {
    FILE *stream;
    uint64_t checksum;
};

/// Write errors are remembered by the stream and found by mf_output_commit.
static void append(struct writer *writer, const void *memory, size_t bytes) {
    if (bytes == 0) // of no memory, perhaps
        return;
    fwrite(memory, 1, bytes, writer->stream);
    mf_digest_add(&writer->checksum, memory, bytes);
}

enum status mf_checkpoint_save(const char *file, uint64_t digest, const struct memory_span *spans,
                               size_t count) {
    struct output output;
    TRY(mf_output_open(&output, file));
    struct writer writer = {output.stream, DIGEST_OF_NOTHING};
    append(&writer, magic, sizeof magic);
    append(&writer, &digest, sizeof digest);
    for (size_t k = 0; k < count; k++) {
        const uint64_t bytes = spans[k].bytes;
        append(&writer, &bytes, sizeof bytes);
        append(&writer, spans[k].memory, spans[k].bytes);
    }
    fwrite(&writer.checksum, sizeof writer.checksum, 1, output.stream);
    return mf_output_commit(&output);
}

static bool read_exactly(FILE *stream, void *memory, size_t bytes) {
    return bytes == 0 || fread(memory, 1, bytes, stream) == bytes;
}

static enum status check_magic(FILE *stream, const char *file) {
    char found[sizeof magic];
    if (read_exactly(stream, found, sizeof found) && memcmp(found, magic, sizeof magic) == 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: not a checkpoint of this version; start again with --force, or "
                          "continue with the version that wrote it",
                          file);
}

static enum status check_digest(FILE *stream, const char *file, uint64_t digest) {
    uint64_t found;
    if (read_exactly(stream, &found, sizeof found) && found == digest)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: the run's settings have changed since it was written; start again "
                          "with --force instead of --resume",
                          file);
}

/// The checksum of all bytes but the last eight must be those eight. A byte on the way to memory
/// must not be changed unseen: the whole run would go another way.
/// @param[out] bytes  of the spans with their lengths
static enum status check_sum(FILE *stream, const char *file, uint64_t *bytes) {
    enum { PIECE = 1 << 16 };
    const uint64_t head = sizeof magic + sizeof(uint64_t);
    unsigned char piece[PIECE + sizeof(uint64_t)];
    uint64_t checksum = DIGEST_OF_NOTHING, found;
    size_t kept = 0, more; // the last bytes so far may be the checksum: they wait for what comes
    *bytes = 0;
    rewind(stream);
    while ((more = fread(piece + kept, 1, PIECE, stream)) > 0) {
        const size_t held = kept + more, done = held > sizeof found ? held - sizeof found : 0;
        mf_digest_add(&checksum, piece, done);
        memmove(piece, piece + done, held - done);
        *bytes += done;
        kept = held - done;
    }
    memcpy(&found, piece, sizeof found);
    if (ferror(stream))
        return mf_status_fail(STATUS_IO, "%s: %s", file, strerror(errno));
    if (kept != sizeof found || *bytes < head || found != checksum)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: the checkpoint is damaged: wrong checksum; start again with "
                              "--force, or restore a copy",
                              file);
    *bytes -= head;
    return STATUS_OK;
}

bool mf_checkpoint_is_of_others(const char *file, uint64_t digest) {
    FILE *stream;
    uint64_t bytes;
    if (mf_input_open(&stream, file) != STATUS_OK)
        return false;
    bool differs =
        check_magic(stream, file) == STATUS_OK && check_sum(stream, file, &bytes) == STATUS_OK;
    rewind(stream);
    differs = differs && check_magic(stream, file) == STATUS_OK &&
              check_digest(stream, file, digest) != STATUS_OK;
    fclose(stream);
    return differs;
}

static enum status fail_shape(const char *file) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: the checkpoint is of another shape", file);
}

/// Open a checkpoint of these settings whose bytes are those that were written, after its head.
/// @param[out] bytes  of what follows, without the checksum
static enum status open_checked(FILE **stream, const char *file, uint64_t digest, uint64_t *bytes) {
    enum status status = STATUS_OK;
    TRY(mf_input_open(stream, file));
    CHECK(check_magic(*stream, file));
    CHECK(check_sum(*stream, file, bytes));
    rewind(*stream);
    CHECK(check_magic(*stream, file));
    CHECK(check_digest(*stream, file, digest));
done:
    if (status != STATUS_OK)
        fclose(*stream);
    return status;
}

/// Read the length of the next span; false if fewer bytes are left.
static bool read_length(FILE *stream, uint64_t *bytes, uint64_t *left) {
    if (*left < sizeof *bytes || !read_exactly(stream, bytes, sizeof *bytes))
        return false;
    *left -= sizeof *bytes;
    if (*bytes > *left)
        return false;
    *left -= *bytes;
    return true;
}

static bool skip(FILE *stream, uint64_t bytes) {
    return fseek(stream, (long)bytes, SEEK_CUR) == 0;
}

/// Whether the file has spans of these lengths and no more.
static bool has_shape(FILE *stream, const struct memory_span *spans, size_t count, uint64_t left) {
    uint64_t bytes;
    for (size_t k = 0; k < count; k++)
        if (!read_length(stream, &bytes, &left) || bytes != spans[k].bytes || !skip(stream, bytes))
            return false;
    return left == 0;
}

static bool read_span(FILE *stream, const struct memory_span *span, uint64_t *left) {
    uint64_t bytes;
    return read_length(stream, &bytes, left) && bytes == span->bytes &&
           read_exactly(stream, span->memory, bytes);
}

enum status mf_checkpoint_load_span(const char *file, uint64_t digest, size_t number,
                                    const struct memory_span *span) {
    FILE *stream;
    uint64_t left, bytes;
    TRY(open_checked(&stream, file, digest, &left));
    bool fits = true;
    for (size_t k = 0; fits && k < number; k++)
        fits = read_length(stream, &bytes, &left) && skip(stream, bytes);
    fits = fits && read_span(stream, span, &left);
    fclose(stream);
    return fits ? STATUS_OK : fail_shape(file);
}

enum status mf_checkpoint_load(const char *file, uint64_t digest, const struct memory_span *spans,
                               size_t count) {
    FILE *stream;
    uint64_t left;
    TRY(open_checked(&stream, file, digest, &left));
    const long begin = ftell(stream);
    bool fits =
        begin >= 0 && has_shape(stream, spans, count, left) && fseek(stream, begin, SEEK_SET) == 0;
    for (size_t k = 0; fits && k < count; k++)
        fits = read_span(stream, &spans[k], &left);
    fclose(stream);
    return fits ? STATUS_OK : fail_shape(file);
}

enum status mf_checkpoint_digest(const char *file, uint64_t *digest) {
    FILE *stream;
    unsigned char piece[4096];
    size_t bytes;
    TRY(mf_input_open(&stream, file));
    *digest = DIGEST_OF_NOTHING;
    while ((bytes = fread(piece, 1, sizeof piece, stream)) > 0)
        mf_digest_add(digest, piece, bytes);
    fclose(stream);
    return STATUS_OK;
}
