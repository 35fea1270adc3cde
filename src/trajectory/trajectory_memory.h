// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Frames of somebody who has no file, in place of a trajectory.
#pragma once

#include "trajectory/trajectory.h"

/// A frame in the units of who lends it. Borrowed until the next one is asked for.
struct trajectory_memory_frame {
    double time;              ///< NAN: not known
    double box[3][3];         ///< its vectors a, b, c, one a row; 0: none
    const double *positions;  ///< shape [atoms, 3]
    const double *velocities; ///< the same, or NULL
    const double *forces;     ///< the same [kJ/mol by the length], or NULL
};

struct trajectory_memory {
    const char *name;                  ///< of the file, exactly as mf_trajectory_open will get it
    const struct structure *structure; ///< of which all atoms are
    size_t frames;       ///< how many there are: any may be asked for again; 0: not known
    double length, time; ///< what 1 is [nm], [ps]
    /// Frame `number`, from 0 on; after frame 0, which may be asked for again, one after the other
    /// unless `frames` is known. `*there` becomes false behind the last.
    enum status (*read)(void *context, size_t number, struct trajectory_memory_frame *frame,
                        bool *there);
    void *context;
};

/// Until the next call, mf_trajectory_open of this thread finds these frames in place of a file of
/// their name. Borrowed; NULL ends it. Tested: test_run.
void mf_trajectory_lend(const struct trajectory_memory *memory_files);

/// The frames of memory of this name, or NULL.
const struct trajectory_memory *mf_trajectory_memory_find(const char *name);

/// Bytes of all frames, in place of a file's size; 0: not known.
uint64_t mf_trajectory_memory_bytes(const struct trajectory_memory *memory_files);

/// How they are read. In no list: a file is never one.
extern const struct trajectory_format mf_trajectory_memory;
