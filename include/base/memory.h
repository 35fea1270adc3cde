// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Aligned, zeroed arrays whose failure is a status and never a crash.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Bytes to which every array is aligned: one cache line, one AVX-512 vector.
enum { MEMORY_ALIGNMENT = 64 };

/// Allocate `count` zeroed elements of `size` bytes, aligned to MEMORY_ALIGNMENT.
/// @return NULL if there is no memory or count × size overflows; the message is set.
void *memory_zeroed(size_t count, size_t size) MUST_USE;

/// A piece of state that a checkpoint keeps.
struct memory_span {
    void *memory;
    size_t bytes;
};

/// Free an array of memory_zeroed; NULL is allowed.
void memory_free(void *array);

/// Allocate an array for `pointer`, or leave the function through CHECK's `done`.
#define NEW_ARRAY(pointer, count)                                                                  \
    CHECK(((pointer) = memory_zeroed((count), sizeof *(pointer))) ? STATUS_OK : STATUS_NO_MEMORY)
