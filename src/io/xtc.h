// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Frames of GROMACS's compressed trajectories, as VMD, MDAnalysis and GROMACS read them:
/// what reader and writer share, and the writer. trajectory/xtc_coordinates.h says how atoms are
/// packed.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/// Frames of so few atoms are not packed.
enum { XTC_MAGIC = 1995, XTC_FEW_ATOMS = 9 };

/// Differences in level k are three digits below radix[k], 2^(k/3) but for a few that the format's
/// author typed otherwise; k bits hold the three.
enum { XTC_FIRST_LEVEL = 9, XTC_LEVELS = 73 };
extern const int32_t mf_xtc_radix[XTC_LEVELS];

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
