// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The pictures of a GIF, for tests that look at them.
#pragma once

#include <stdint.h>

struct gif {
    int pictures;
    int width, height;
    uint32_t *pixel; ///< shape [height, width]: colours of the last picture as 0xrrggbb
};

/// Read a file whose pictures are whole ones, as gnuplot writes them; anything else fails the test.
struct gif gif_read(const char *file);
void gif_clear(struct gif *gif);
