// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A copy of state, as a checkpoint keeps it, while the state itself goes on.
#pragma once

#include "base/memory.h"

/// Zeroed: of nothing.
struct memory_image {
    struct memory_span *span; ///< shape [count]: in `bytes`
    size_t count;
    char *bytes;
};

/// Copy what the spans have now. Fails: NO_MEMORY; the image is then the one before.
enum status mf_memory_image_take(struct memory_image *image, const struct memory_span *spans,
                                 size_t count) MUST_USE;
void mf_memory_image_clear(struct memory_image *image);
