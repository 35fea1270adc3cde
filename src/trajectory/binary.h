// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Numbers of binary files, in either order of bytes; none need be aligned.
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static inline uint32_t binary_word(const unsigned char *at, bool big) {
    const uint32_t a = at[0], b = at[1], c = at[2], d = at[3];
    return big ? a << 24 | b << 16 | c << 8 | d : d << 24 | c << 16 | b << 8 | a;
}

static inline int32_t binary_int(const unsigned char *at, bool big) {
    return (int32_t)binary_word(at, big);
}

static inline uint64_t binary_long(const unsigned char *at, bool big) {
    const uint64_t first = binary_word(at, big), second = binary_word(at + 4, big);
    return big ? first << 32 | second : second << 32 | first;
}

static inline double binary_float(const unsigned char *at, bool big) {
    const uint32_t word = binary_word(at, big);
    float value;
    memcpy(&value, &word, sizeof value);
    return (double)value;
}

static inline double binary_double(const unsigned char *at, bool big) {
    const uint64_t bits = binary_long(at, big);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/// Number `k` of an array, of 4 or 8 bytes each.
static inline double binary_real(const unsigned char *array, size_t k, size_t bytes, bool big) {
    return bytes == 8 ? binary_double(array + 8 * k, big) : binary_float(array + 4 * k, big);
}

/// Print the lowest `bytes` bytes of a number.
static inline void binary_put(FILE *stream, uint64_t bits, int bytes, bool big) {
    for (int k = 0; k < bytes; k++)
        putc((int)(bits >> 8 * (big ? bytes - 1 - k : k) & 0xff), stream);
}

static inline void binary_put_float(FILE *stream, double number, bool big) {
    const float value = (float)number;
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    binary_put(stream, bits, sizeof bits, big);
}
