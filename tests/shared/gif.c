// SPDX-License-Identifier: GPL-3.0-or-later
//
// Graphics Interchange Format, Version 89a (CompuServe, 1990).
#include "shared/gif.h"

#include "shared/testing.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CODES = 4096, EXTENSION = 0x21, PICTURE = 0x2c };

/// Bits of a picture, which stand in blocks of at most 255 bytes.
struct bits {
    FILE *stream;
    int left; ///< bytes of the block
    unsigned held, count;
};

static int byte_of(FILE *stream) {
    const int byte = getc(stream);
    assert_int_not_equal(byte, EOF);
    return byte;
}

static int word_of(FILE *stream) {
    const int low = byte_of(stream);
    return low | byte_of(stream) << 8;
}

static int next_code(struct bits *bits, unsigned width) {
    while (bits->count < width) {
        if (bits->left == 0)
            bits->left = byte_of(bits->stream);
        assert_true(bits->left-- > 0);
        bits->held |= (unsigned)byte_of(bits->stream) << bits->count;
        bits->count += 8;
    }
    const unsigned code = bits->held & ((1u << width) - 1);
    bits->held >>= width;
    bits->count -= width;
    return (int)code;
}

/// Pass over what is left of blocks.
static void skip_blocks(FILE *stream, int left) {
    for (; left > 0; left = byte_of(stream))
        assert_int_equal(fseek(stream, left, SEEK_CUR), 0);
}

/// Each code is a row of colours: that of an earlier code and one more.
static void decode(FILE *stream, const uint32_t *colours, uint32_t *pixel, size_t pixels) {
    static int before[CODES], length[CODES], last[CODES];
    const unsigned depth = (unsigned)byte_of(stream);
    const int clear = 1 << depth;
    struct bits bits = {.stream = stream};
    int codes = clear + 2, earlier = -1;
    unsigned width = depth + 1;
    size_t done = 0;
    for (int code = 0; code < clear; code++)
        length[code] = 1, last[code] = code;
    for (int code; (code = next_code(&bits, width)) != clear + 1;) {
        if (code == clear) {
            codes = clear + 2, width = depth + 1, earlier = -1;
            continue;
        }
        const bool is_new = code == codes;
        assert_true(code < codes || (is_new && earlier >= 0));
        if (earlier >= 0 && codes < CODES) {
            before[codes] = earlier, length[codes] = length[earlier] + 1;
            int first = is_new ? earlier : code;
            while (length[first] > 1)
                first = before[first];
            last[codes++] = last[first];
        }
        assert_true(done + (size_t)length[code] <= pixels);
        done += (size_t)length[code];
        for (size_t at = done, k = (size_t)length[code], c = (size_t)code; k > 0; k--) {
            pixel[--at] = colours[last[c]];
            c = k > 1 ? (size_t)before[c] : c;
        }
        earlier = code;
        width += codes == 1 << width && width < 12;
    }
    assert_int_equal(done, pixels);
    skip_blocks(stream, bits.left);
    assert_int_equal(byte_of(stream), 0);
}

static void read_colours(FILE *stream, int flags, uint32_t colours[256]) {
    for (int k = 0; flags & 0x80 && k < 2 << (flags & 7); k++) {
        colours[k] = (uint32_t)byte_of(stream) << 16;
        colours[k] |= (uint32_t)byte_of(stream) << 8;
        colours[k] |= (uint32_t)byte_of(stream);
    }
}

static void read_picture(FILE *stream, struct gif *gif, uint32_t colours[256]) {
    int edge[4];
    for (int k = 0; k < 4; k++)
        edge[k] = word_of(stream);
    assert_true(edge[0] == 0 && edge[1] == 0);
    assert_true(edge[2] == gif->width && edge[3] == gif->height);
    read_colours(stream, byte_of(stream), colours);
    decode(stream, colours, gif->pixel, (size_t)gif->width * (size_t)gif->height);
    gif->pictures++;
}

struct gif gif_read(const char *file) {
    struct gif gif = {0};
    uint32_t colours[256] = {0};
    char head[7] = "";
    FILE *stream = fopen(file, "rb");
    assert_non_null(stream);
    assert_int_equal(fread(head, 1, 6, stream), 6);
    assert_string_equal(head, "GIF89a");
    gif.width = word_of(stream);
    gif.height = word_of(stream);
    gif.pixel = calloc((size_t)gif.width * (size_t)gif.height, sizeof *gif.pixel);
    assert_non_null(gif.pixel);
    const int flags = byte_of(stream);
    word_of(stream);
    read_colours(stream, flags, colours);
    for (int kind; (kind = byte_of(stream)) != ';';)
        if (kind == PICTURE)
            read_picture(stream, &gif, colours);
        else {
            assert_int_equal(kind, EXTENSION);
            byte_of(stream);
            skip_blocks(stream, byte_of(stream));
        }
    fclose(stream);
    return gif;
}

void gif_clear(struct gif *gif) {
    free(gif->pixel);
    *gif = (struct gif){0};
}
