// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/visible.h"

#include <math.h>
#include <string.h>

/// Bytes that a character with this first byte has, 0 if none begins with it.
static size_t length_of(unsigned char first) {
    if (first < 0x80)
        return 1;
    return first < 0xc2 || first > 0xf4 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

/// Whether the second byte can follow the first one: no longer spellings, no surrogates, nothing
/// beyond U+10FFFF.
static bool can_follow(unsigned char first, unsigned char second) {
    const unsigned char min = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned char max = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    return second >= min && second <= max;
}

/// Bytes, of `size`, that can stand in the character of `length` bytes that the first one begins.
static size_t count_fitting(const char *text, size_t size, size_t length) {
    size_t fitting = 1;
    while (fitting < length && fitting < size &&
           (fitting == 1 ? can_follow((unsigned char)text[0], (unsigned char)text[1])
                         : ((unsigned char)text[fitting] & 0xc0) == 0x80))
        fitting++;
    return fitting;
}

size_t mf_visible_character(const char *text, size_t size) {
    const size_t length = size > 0 ? length_of((unsigned char)text[0]) : 0;
    return length > 0 && count_fitting(text, size, length) == length ? length : 0;
}

bool mf_visible_is_begun(const char *text, size_t size) {
    const size_t length = size > 0 ? length_of((unsigned char)text[0]) : 0;
    return size < length && count_fitting(text, size, length) == size;
}

static bool is_control(const char *text, size_t bytes) {
    const unsigned char first = (unsigned char)text[0];
    return bytes == 0 || (bytes == 1 && (first < 0x20 || first == 0x7f)) ||
           (first == 0xc2 && (unsigned char)text[1] <= 0x9f);
}

size_t mf_visible_show(const char *text, size_t size, const char *kept, char shown[VISIBLE_MAX],
                       size_t *taken) {
    static const char digits[] = "0123456789abcdef";
    const size_t bytes = mf_visible_character(text, size);
    *taken = bytes > 0 ? bytes : 1;
    if (!is_control(text, bytes) || (text[0] && strchr(kept, text[0]))) {
        memcpy(shown, text, *taken);
        return *taken;
    }
    for (size_t k = 0; k < *taken; k++) {
        const unsigned char byte = (unsigned char)text[k];
        memcpy(shown + 4 * k, (const char[]){'\\', 'x', digits[byte >> 4], digits[byte & 15]}, 4);
    }
    return 4 * *taken;
}

void mf_visible_copy(char *copy, size_t size, const char *text, const char *kept) {
    size_t used = 0, left = strlen(text), taken;
    for (; left > 0; text += taken, left -= taken) {
        char shown[VISIBLE_MAX];
        const size_t bytes = mf_visible_show(text, left, kept, shown, &taken);
        if (used + bytes >= size)
            break;
        memcpy(copy + used, shown, bytes);
        used += bytes;
    }
    copy[used] = '\0';
}

double mf_visible_number(double number) {
    return isnan(number) ? (double)NAN : number;
}
