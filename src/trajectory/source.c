// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/source.h"

#include "base/growing.h"
#include "io/input.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { BUFFER_SIZE = 1 << 18, LONGEST_LINE = 1 << 20, LARGEST_PIECE = 1 << 24 };

enum status mf_source_capacity(struct bytes *bytes, size_t more) {
    return mf_growing_reserve(&bytes->data, &bytes->capacity, bytes->size, bytes->size + more, 1,
                              1);
}

enum status mf_source_note(struct bytes *bytes, const char *format, va_list arguments) {
    char line[1024];
    vsnprintf(line, sizeof line, format, arguments);
    const size_t length = strlen(line);
    TRY(mf_source_capacity(bytes, length + 2));
    memcpy(bytes->data + bytes->size, line, length);
    memcpy(bytes->data + bytes->size + length, "\n", 2);
    bytes->size += length + 1;
    return STATUS_OK;
}

void mf_source_free(struct bytes *bytes) {
    mf_memory_free(bytes->data);
    *bytes = (struct bytes){0};
}

/// What reading less than was wanted means, but for the end of the file.
static enum status check_stream(const struct source *source) {
    if (ferror(source->stream))
        return mf_status_fail(STATUS_IO, "%s: frame %zu, byte %llu: %s", source->file,
                              source->frame, (unsigned long long)source->byte, strerror(errno));
    if (source->unpack && mf_unpack_fault(source->unpack))
        return mf_source_fail_byte(source, "%s", mf_unpack_fault(source->unpack));
    return STATUS_OK;
}

static size_t read_some(struct source *source, unsigned char *to, size_t count) {
    return source->unpack ? mf_unpack_read(source->unpack, source->stream, to, count)
                          : fread(to, 1, count, source->stream);
}

/// Have something in the buffer, unless the file has ended.
static enum status fill(struct source *source) {
    if (source->begin < source->end)
        return STATUS_OK;
    source->begin = 0;
    source->end = read_some(source, source->buffer, BUFFER_SIZE);
    return source->end > 0 ? STATUS_OK : check_stream(source);
}

/// What Windows puts before UTF-8 is no part of a text, and no binary format begins so.
static enum status skip_byte_order_mark(struct source *source) {
    static const char mark[] = "\xEF\xBB\xBF";
    enum { SIZE = sizeof mark - 1 };
    TRY(fill(source));
    if (source->end < SIZE || memcmp(source->buffer, mark, SIZE) != 0)
        return STATUS_OK;
    source->begin = SIZE;
    source->byte = SIZE;
    return STATUS_OK;
}

/// The first bytes tell whether the file is compressed.
static enum status begin(struct source *source) {
    source->end = read_some(source, source->buffer, BUFFER_SIZE);
    TRY(check_stream(source));
    TRY(mf_unpack_begin(&source->unpack, source->file, source->buffer, source->end));
    if (source->unpack)
        source->end = 0;
    return skip_byte_order_mark(source);
}

enum status mf_source_open(struct source *source, const char *file) {
    *source = (struct source){.file = file};
    TRY(mf_input_open(&source->stream, file));
    setvbuf(source->stream, NULL, _IONBF, 0); // the buffer is our own
    source->buffer = mf_memory_uncleared(BUFFER_SIZE, 1);
    const enum status status = source->buffer ? begin(source) : STATUS_NO_MEMORY;
    if (status != STATUS_OK)
        mf_source_close(source);
    return status;
}

void mf_source_stand_in(struct source *source, const char *file) {
    *source = (struct source){.file = file, .end = 1};
}

void mf_source_close(struct source *source) {
    if (source->stream)
        fclose(source->stream);
    mf_unpack_end(source->unpack);
    mf_memory_free(source->buffer);
    *source = (struct source){0};
}

uint64_t mf_source_done(const struct source *source) {
    return source->unpack ? mf_unpack_bytes(source->unpack) : source->byte;
}

enum status mf_source_peek(struct source *source, const unsigned char **begin, size_t *size) {
    TRY(fill(source));
    *begin = source->buffer + source->begin;
    *size = source->end - source->begin;
    if (*size > SOURCE_PEEK)
        *size = SOURCE_PEEK;
    return STATUS_OK;
}

enum status mf_source_more(struct source *source, bool *more) {
    TRY(fill(source));
    *more = source->begin < source->end;
    return STATUS_OK;
}

enum status mf_source_seek(struct source *source, uint64_t byte) {
    struct stat about;
    if (source->unpack || fstat(fileno(source->stream), &about) != 0 || !S_ISREG(about.st_mode))
        return mf_source_fail_byte(source, "its format has an index, which needs a file, neither "
                                           "compressed nor a pipe");
    if (byte > (uint64_t)about.st_size)
        return mf_source_fail_byte(source,
                                   "byte %llu follows, but the file has only %llu: it is damaged",
                                   (unsigned long long)byte, (unsigned long long)about.st_size);
    const uint64_t left = source->end - source->begin; // of the buffer
    if (byte >= source->byte && byte - source->byte < left) {
        source->begin += (size_t)(byte - source->byte);
    } else {
        source->begin = source->end = 0;
        if (fseeko(source->stream, (off_t)byte, SEEK_SET) != 0)
            return mf_status_fail(STATUS_IO, "%s: %s", source->file, strerror(errno));
    }
    source->byte = byte;
    return STATUS_OK;
}

/// Bytes from the buffer first, then from the file past the buffer: at most `count`.
static size_t take_some(struct source *source, unsigned char *to, size_t count) {
    size_t taken = source->end - source->begin;
    if (taken > count)
        taken = count;
    if (taken > 0)
        memcpy(to, source->buffer + source->begin, taken);
    source->begin += taken;
    if (taken < count)
        taken += read_some(source, to + taken, count - taken);
    source->byte += taken;
    return taken;
}

enum status mf_source_take(struct source *source, struct bytes *bytes, uint64_t count) {
    while (count > 0) {
        const size_t piece = count < LARGEST_PIECE ? (size_t)count : LARGEST_PIECE;
        TRY(mf_source_capacity(bytes, piece));
        const size_t taken = take_some(source, bytes->data + bytes->size, piece);
        bytes->size += taken;
        count -= taken;
        if (taken < piece)
            TRY(check_stream(source));
        if (taken < piece)
            return mf_source_fail_byte(source,
                                       "the file ends within the frame, %llu bytes are missing",
                                       (unsigned long long)count);
    }
    return STATUS_OK;
}

/// Append what of the line is in the buffer; true if its end was among it.
static enum status take_line_part(struct source *source, struct bytes *bytes, bool *ended) {
    const unsigned char *begin = source->buffer + source->begin;
    const size_t available = source->end - source->begin;
    const unsigned char *end = memchr(begin, '\n', available);
    const size_t length = end ? (size_t)(end - begin) : available;
    *ended = end != NULL;
    TRY(mf_source_capacity(bytes, length + 1));
    memcpy(bytes->data + bytes->size, begin, length);
    bytes->size += length;
    source->begin += length + *ended;
    source->byte += length + *ended;
    return STATUS_OK;
}

enum status mf_source_line(struct source *source, struct bytes *bytes, bool *there) {
    const size_t first = bytes->size;
    bool ended = false;
    TRY(mf_source_more(source, there));
    if (!*there)
        return STATUS_OK;
    source->line++;
    for (bool more = true; more && !ended;) {
        TRY(take_line_part(source, bytes, &ended));
        if (bytes->size - first > LONGEST_LINE)
            return mf_source_fail_line(source, "a line of more than %d bytes", LONGEST_LINE);
        if (!ended)
            TRY(mf_source_more(source, &more));
    }
    source->broken_line = !ended;
    if (memchr(bytes->data + first, '\0', bytes->size - first))
        return mf_source_fail_line(source, "a NUL byte: not a text file");
    while (bytes->size > first && bytes->data[bytes->size - 1] == '\r')
        bytes->size--;
    if (memchr(bytes->data + first, '\r', bytes->size - first))
        return mf_source_fail_line(source, "lines end with CR alone, as on old Macs: convert them");
    bytes->data[bytes->size++] = '\0';
    return STATUS_OK;
}

enum status mf_source_lines(struct source *source, struct bytes *bytes, uint64_t count) {
    for (uint64_t k = 0; k < count; k++) {
        bool there;
        TRY(mf_source_line(source, bytes, &there));
        if (!there)
            return mf_source_fail_line(source,
                                       "the file ends within the frame, %llu lines are missing",
                                       (unsigned long long)(count - k));
        if (source->broken_line && source->frame > 0)
            return mf_source_fail_line(source, "the file ends within this line");
    }
    return STATUS_OK;
}

enum { REASON_SIZE = 1024 };

enum status mf_source_fail_line(const struct source *source, const char *format, ...) {
    char reason[REASON_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: frame %zu: %s", source->file, source->line,
                          source->frame, reason);
}

enum status mf_source_fail_byte(const struct source *source, const char *format, ...) {
    char reason[REASON_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu, byte %llu: %s", source->file,
                          source->frame, (unsigned long long)source->byte, reason);
}
