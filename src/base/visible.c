// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/visible.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// Bytes of the control character at `text`: 0 if there is none.
static size_t control_bytes(const char *text) {
    const unsigned char first = (unsigned char)text[0], second = (unsigned char)text[1];
    if (first < 0x20 || first == 0x7f)
        return 1;
    return first == 0xc2 && second >= 0x80 && second <= 0x9f ? 2 : 0;
}

void mf_visible_copy(char *copy, size_t size, const char *text, const char *kept) {
    char *end = copy;
    while (*text) {
        const size_t bytes = strchr(kept, *text) ? 0 : control_bytes(text);
        if (end + (bytes ? 4 * bytes : 1) >= copy + size)
            break;
        for (size_t k = 0; k < bytes; k++)
            end += sprintf(end, "\\x%02x", (unsigned char)text[k]);
        if (bytes == 0)
            *end++ = *text;
        text += bytes ? bytes : 1;
    }
    *end = '\0';
}

double mf_visible_number(double number) {
    return isnan(number) ? (double)NAN : number;
}
