// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Chunks of a GSD file by frame and name, found by its index (gsd.readthedocs.io: file layer
/// 1 and 2, schema hoomd), read and written: what format_gsd.c and gsd_print.c are made of.
/// Little-endian.
#pragma once

#include "trajectory/trajectory.h"

#include <stdio.h>

enum { GSD_NAME = 64 }; ///< bytes of a name of a type as we write it

/// By names of the schema, in the order in which we write them; terms stand in the order of bonds,
/// angles, dihedrals.
enum gsd_chunk {
    STEP,
    DIMENSIONS,
    BOX,
    COUNT,
    TYPES,
    TYPE,
    MASS,
    POSITION,
    VELOCITY,
    IMAGE,
    BONDS,
    BOND_TYPES,
    ANGLE_TYPES,
    DIHEDRAL_TYPES,
    BOND_TYPE,
    ANGLE_TYPE,
    DIHEDRAL_TYPE,
    BOND,
    ANGLE,
    DIHEDRAL,
    CONSTRAINT,
    CHUNKS
};

/// State of the format.
struct gsd {
    struct bytes index; ///< as in the file
    size_t entries;     ///< that are used
    int64_t id[CHUNKS]; ///< of their names; −1: no frame has it
    bool moves;         ///< velocities are those of each frame
    uint32_t atoms;
    struct bytes types; ///< of the atoms in the first frame, as in the file; empty: all of type 0
};

enum status mf_gsd_open(struct trajectory *trajectory) MUST_USE;
void mf_gsd_close(struct trajectory *trajectory);

/// Its name in the file.
const char *mf_gsd_name(enum gsd_chunk chunk);

/// The entry of a chunk of a frame; NULL if it has none.
const unsigned char *mf_gsd_find(const struct gsd *gsd, uint64_t frame, enum gsd_chunk chunk);

/// Append the numbers of a chunk, or of that of frame 0, of `rows` rows, 0: any. However the file
/// has them, lengths, masses and velocities become doubles, steps 8 bytes and other integers 4.
/// @param[out] rows_found  0: neither frame has it
enum status mf_gsd_take(struct trajectory *trajectory, uint64_t frame, enum gsd_chunk chunk,
                        uint64_t rows, struct bytes *raw, uint64_t *rows_found,
                        uint32_t *columns_found) MUST_USE;

/// The same of what may be missing, and whose columns are known.
enum status mf_gsd_take_if(struct trajectory *trajectory, uint64_t frame, enum gsd_chunk chunk,
                           uint64_t rows, struct bytes *raw, bool *there) MUST_USE;

/// One number of up to 8 bytes; the usual one if the file has none.
enum status mf_gsd_take_number(struct trajectory *trajectory, uint64_t frame, enum gsd_chunk chunk,
                               uint64_t usual, struct bytes *raw, uint64_t *number) MUST_USE;

/// What is written: the rows of a chunk of a frame, 0 if the frame has none, and their numbers, by
/// mf_gsd_put. Frame 0 has all chunks that any frame has.
struct gsd_content {
    size_t (*rows)(const void *context, enum gsd_chunk chunk, size_t frame);
    void (*put)(const void *context, enum gsd_chunk chunk, FILE *stream);
    const void *context;
};

/// A whole number in the width of its chunk, a real one, the name of a type.
void mf_gsd_put(enum gsd_chunk chunk, int64_t number, FILE *stream);
void mf_gsd_put_real(double number, FILE *stream);
void mf_gsd_put_name(const char *name, FILE *stream);

/// One frame after the other, from the place where the one before has ended; what there is is a
/// whole file after each of them. The stream can seek.
void mf_gsd_put_frame(const struct gsd_content *content, size_t frame, FILE *stream);

/// Forget frames from this number on, of a file that was cut where they began.
void mf_gsd_cut(const struct gsd_content *content, size_t frames, FILE *stream);

/// As struct trajectory_format has them. Fails: BAD_INPUT without a box, for one that the format
/// has not, and without velocities if the first frame had them.
enum status mf_gsd_print_beads(struct beads_file *file,
                               const struct trajectory_frame *beads) MUST_USE;
