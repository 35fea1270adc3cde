// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Files that gzip or zstd have compressed, read as what was compressed: by zlib and libzstd,
/// each where it was there when mesofit was built. Tested: test_trajectory_packed.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct unpack;

/// Begin if the first bytes of a file are those of gzip or zstd; else *unpack is NULL.
/// @param[in] begin  what of the stream has been read, which is copied
/// Fails: BAD_INPUT for what this mesofit was built without, with the remedy; NO_MEMORY.
enum status mf_unpack_begin(struct unpack **unpack, const char *file, const unsigned char *begin,
                            size_t size) MUST_USE;

/// The next `count` bytes, or fewer at the end or before a fault.
size_t mf_unpack_read(struct unpack *unpack, FILE *stream, unsigned char *to, size_t count);

/// What is wrong with the compressed file, a line; NULL: nothing yet.
const char *mf_unpack_fault(const struct unpack *unpack);

/// Bytes of the compressed file that have been read.
uint64_t mf_unpack_bytes(const struct unpack *unpack);

/// NULL is let be.
void mf_unpack_end(struct unpack *unpack);
