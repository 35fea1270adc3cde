// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Chunks of a GSD file by frame and name, found by its index: what format_gsd.c is made of.
#pragma once

#include "trajectory/trajectory.h"

/// What is read, by names of the schema; terms stand in the order of bonds, angles, dihedrals.
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
    BOND,
    ANGLE,
    DIHEDRAL,
    CONSTRAINT,
    BOND_TYPE,
    ANGLE_TYPE,
    DIHEDRAL_TYPE,
    BOND_TYPES,
    ANGLE_TYPES,
    DIHEDRAL_TYPES,
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

enum status mf_gsd_chunks_open(struct trajectory *trajectory) MUST_USE;
void mf_gsd_chunks_close(struct trajectory *trajectory);

/// Its name in the file.
const char *mf_gsd_chunks_name(enum gsd_chunk chunk);

/// The entry of a chunk of a frame; NULL if it has none.
const unsigned char *mf_gsd_chunks_find(const struct gsd *gsd, uint64_t frame,
                                        enum gsd_chunk chunk);

/// Append the numbers of a chunk, or of that of frame 0, of `rows` rows, 0: any. However the file
/// has them, lengths, masses and velocities become doubles, steps 8 bytes and other integers 4.
/// @param[out] rows_found  0: neither frame has it
enum status mf_gsd_chunks_take(struct trajectory *trajectory, uint64_t frame, enum gsd_chunk chunk,
                               uint64_t rows, struct bytes *raw, uint64_t *rows_found,
                               uint32_t *columns_found) MUST_USE;

/// The same of what may be missing, and whose columns are known.
enum status mf_gsd_chunks_take_if(struct trajectory *trajectory, uint64_t frame,
                                  enum gsd_chunk chunk, uint64_t rows, struct bytes *raw,
                                  bool *there) MUST_USE;

/// One number of up to 8 bytes; the usual one if the file has none.
enum status mf_gsd_chunks_take_number(struct trajectory *trajectory, uint64_t frame,
                                      enum gsd_chunk chunk, uint64_t usual, struct bytes *raw,
                                      uint64_t *number) MUST_USE;
