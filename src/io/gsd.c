// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/gsd.h"

#include <string.h>

void mf_gsd_put(FILE *stream, uint64_t bits, int bytes) {
    for (int k = 0; k < bytes; k++)
        putc((int)(bits >> 8 * k & 0xff), stream);
}

void mf_gsd_put_float(FILE *stream, double number) {
    const float value = (float)number;
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    mf_gsd_put(stream, bits, sizeof bits);
}

void mf_gsd_put_text(FILE *stream, const char *text, size_t width) {
    for (size_t k = 0, length = strlen(text); k < width; k++)
        putc(k < length ? text[k] : '\0', stream);
}

void mf_gsd_put_head(FILE *stream, uint64_t index, uint64_t entries, uint64_t names) {
    mf_gsd_put(stream, 0x65DF65DF65DF65DF, 8);
    mf_gsd_put(stream, index, 8);
    mf_gsd_put(stream, entries, 8);
    mf_gsd_put(stream, index + entries * GSD_ENTRY, 8);
    mf_gsd_put(stream, names, 8); // of up to 64 bytes each
    mf_gsd_put(stream, 1 << 16 | 4, 4);
    mf_gsd_put(stream, 2 << 16, 4);
    mf_gsd_put_text(stream, "mesofit", GSD_NAME);
    mf_gsd_put_text(stream, "hoomd", GSD_NAME);
    mf_gsd_put_text(stream, "", GSD_HEAD - 2 * GSD_NAME - 48);
}

void mf_gsd_put_entry(FILE *stream, const struct gsd_entry *entry) {
    mf_gsd_put(stream, entry->frame, 8);
    mf_gsd_put(stream, entry->rows, 8);
    mf_gsd_put(stream, entry->at, 8);
    mf_gsd_put(stream, entry->columns, 4);
    mf_gsd_put(stream, (uint64_t)entry->id, 2);
    mf_gsd_put(stream, entry->type, 1);
    mf_gsd_put(stream, 0, 1);
}
