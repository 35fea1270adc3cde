// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The compressed coordinates of xtc files, read and written.
///
/// The format is that of F. van Hoesel's routine xdr3dfcoord, as the GROMACS manual names it.
/// Coordinates are rounded to whole numbers. An atom is either three digits of a mixed
/// radix, which count from the least coordinates of the frame, or, in a run after such an atom,
/// the difference from the atom before, in a radix that grows and shrinks as differences
/// do. The first two atoms of a run are exchanged, so that of a water both hydrogens are near the
/// oxygen. Tested: test_xtc_coordinates, test_xtc.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/// Frames of so few atoms are not packed.
enum { XTC_MAGIC = 1995, XTC_FEW_ATOMS = 9 };

/// What a frame says before the bits.
struct xtc_packing {
    size_t atoms;
    double precision;       ///< coordinates are whole multiples of 1/precision [1/nm]
    int32_t min[3], max[3]; ///< of all coordinates, as whole numbers
    int32_t level;          ///< with which the radix of differences begins
};

/// Bytes after the bits that must be there to read, whatever they hold.
enum { XTC_SLACK = 256 };

/// Whether `packing` can be: its ranges are ranges, and each atom takes 9 bits at least but for
/// those in full, so that no more atoms are promised than `bytes` may hold.
/// @return NULL if so, else what is wrong
const char *mf_xtc_check(const struct xtc_packing *packing, size_t bytes);

/// Unpack all atoms. Threads: any number at once.
/// @param[in]  data      shape [bytes + XTC_SLACK]
/// @param[out] position  shape [packing->atoms, 3] [nm]
/// @return NULL, or what is wrong; `*damage` is then near which byte of data
const char *mf_xtc_unpack(const struct xtc_packing *packing, const unsigned char *data,
                          size_t bytes, double (*position)[3], size_t *damage);

/// Numbers in nm and ps. Positions are rounded to whole multiples of 0.001 nm.
struct xtc_frame {
    size_t atoms;
    int64_t step;
    double time, box[3][3];
    void (*place)(const void *context, size_t atom, double position[3]);
    const void *context;
};

/// The farthest coordinate that a frame may have [nm]: others would be written as this.
#define XTC_FARTHEST 1e6

/// Write a frame. What cannot be written, the stream knows. Tested: test_xtc, cli/test_snapshots.
void mf_xtc_write(const struct xtc_frame *frame, FILE *stream);
