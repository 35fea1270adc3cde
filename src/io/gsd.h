// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Layout of GSD files, little-endian (gsd.readthedocs.io, file layer): bytes of the head, of
/// an entry of the index and of a name, and the types of numbers.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { GSD_HEAD = 256, GSD_ENTRY = 32, GSD_NAME = 64 };

enum gsd_type {
    GSD_UINT8 = 1,
    GSD_UINT16,
    GSD_UINT32,
    GSD_UINT64,
    GSD_INT8,
    GSD_INT16,
    GSD_INT32,
    GSD_INT64,
    GSD_FLOAT,
    GSD_DOUBLE,
    GSD_CHARACTER
};

/// The lowest `bytes` bytes of a number; a float; a text of `width` bytes, filled with 0.
void mf_gsd_put(FILE *stream, uint64_t bits, int bytes);
void mf_gsd_put_float(FILE *stream, double number);
void mf_gsd_put_text(FILE *stream, const char *text, size_t width);

/// The head of a file whose index stands at byte `index`, with the names behind it.
void mf_gsd_put_head(FILE *stream, uint64_t index, uint64_t entries, uint64_t names);

/// An entry of the index, which is sorted by frames and ids.
struct gsd_entry {
    uint64_t frame, rows, at; ///< at: byte of its numbers
    unsigned columns;
    int id; ///< which of the names
    enum gsd_type type;
};
void mf_gsd_put_entry(FILE *stream, const struct gsd_entry *entry);
