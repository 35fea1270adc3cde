// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The bytes of a trajectory, taken one after the other.
///
/// Nothing is trusted that a file says of itself: memory grows with what has really been read, so
/// that a header which promises 2^60 atoms costs nothing. Forwards, so that pipes will do; only a
/// format with an index goes where that says (mf_source_seek). Threads: one source belongs to one
/// thread. Tested: test_trajectory_damage.
#pragma once

#include "base/status.h"
#include "trajectory/unpack.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/// Bytes that are kept and used again; all zero is none.
struct bytes {
    unsigned char *data;
    size_t size, capacity;
};

/// Make room for `more` bytes after those that are there, which stay. Fails: NO_MEMORY.
enum status mf_source_capacity(struct bytes *bytes, size_t more) MUST_USE;

/// Add a line to a text. Fails: NO_MEMORY.
enum status mf_source_note(struct bytes *bytes, const char *format, va_list arguments) MUST_USE;

void mf_source_free(struct bytes *bytes);

struct source {
    const char *file; ///< borrowed
    FILE *stream;
    unsigned char *buffer;
    size_t begin, end;     ///< what of the buffer is not yet taken
    uint64_t byte;         ///< of the file, or of what was compressed, that would be taken next
    size_t line;           ///< lines taken so far
    size_t frame;          ///< that is being read, for messages; the first is 0
    struct unpack *unpack; ///< of a compressed file, or NULL
    bool broken_line;      ///< the last line taken had no end: the file ends there
};

/// A file that gzip or zstd have compressed is read as what was compressed.
/// Fails: IO, NO_MEMORY; BAD_INPUT as mf_unpack_begin. A failed source is closed, too.
enum status mf_source_open(struct source *source, const char *file) MUST_USE;

/// A source of no bytes, of which there is always more: who reads knows when it ends.
void mf_source_stand_in(struct source *source, const char *file);

void mf_source_close(struct source *source);

/// Bytes of the file that have been read, compressed or not.
uint64_t mf_source_done(const struct source *source);

/// The first bytes, which stay to be taken: the whole file if it is short.
enum { SOURCE_PEEK = 4096 };
enum status mf_source_peek(struct source *source, const unsigned char **begin,
                           size_t *size) MUST_USE;

/// Append the next `count` bytes to `bytes`. Fails: BAD_INPUT with frame and byte if the file ends
/// before; IO, NO_MEMORY.
enum status mf_source_take(struct source *source, struct bytes *bytes, uint64_t count) MUST_USE;

/// Go on at this byte of the file. Fails: BAD_INPUT for a pipe, whose bytes come once, for a
/// compressed file, and for a place beyond the end; IO.
enum status mf_source_seek(struct source *source, uint64_t byte) MUST_USE;

/// Whether there is another byte. Fails: IO.
enum status mf_source_more(struct source *source, bool *more) MUST_USE;

/// Append the next line to `bytes`, with a NUL in place of its end; a carriage return before it is
/// dropped. `*there` is false if the file has ended. Fails: BAD_INPUT for a line that is no text or
/// longer than a MiB; IO, NO_MEMORY.
enum status mf_source_line(struct source *source, struct bytes *bytes, bool *there) MUST_USE;

/// Append `count` lines, all of which must be there and, but for the first frame, have an end: what
/// programs write ends its lines, and half a number is a number, too.
enum status mf_source_lines(struct source *source, struct bytes *bytes, uint64_t count) MUST_USE;

/// BAD_INPUT of the line that was taken last: "file:line: frame 3: …".
enum status mf_source_fail_line(const struct source *source, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/// BAD_INPUT of the byte that would be taken next: "file: frame 3, byte 1234: …".
enum status mf_source_fail_byte(const struct source *source, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
