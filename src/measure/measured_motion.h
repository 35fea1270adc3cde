// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is measured of frames that are equally far apart in time: motion and escape times.
#pragma once

#include "measure/frame_motion.h"
#include "observe/etd.h"
#include "observe/motion.h"
#include "observe/sample_series.h"
#include "trajectory/mapping.h"

/// Where the velocities of the VACF come from.
enum measured_velocities {
    MEASURED_VELOCITIES_USUAL, ///< of the frames if the first has them, else none
    MEASURED_VELOCITIES_FILE,
    MEASURED_VELOCITIES_DIFFERENCES,
    MEASURED_VELOCITIES_NONE,
};

/// Names of these, NULL-terminated.
extern const char *const mf_measured_velocities[];

/// Frames from which on the usual window does not grow.
enum { MEASURED_MOTION_FRAMES = 1000 };

/// Pairs are followed to at most this part of half the least height of boxes, unless told.
static const double measured_motion_most = 0.9;

struct measured_motion_plan {
    bool leave_out;  ///< all of it: frames need no times
    int velocities;  ///< enum measured_velocities
    double window;   ///< [ps]; 0: a tenth of the trajectory, or 100 frames if that is less
    double escape;   ///< r_maximum of escape times [nm]; 0: 1.6 ρ^(−1/3), at most 0.45 heights
    size_t expected; ///< frames that there may be; 0: not known
    int threads;
};

struct measured_motion {
    struct measured_motion_plan plan;
    bool begun;
    bool has_vacf;
    bool is_thermal; ///< velocities tell the temperature, if there are any; with or without times
    bool together;   ///< beads are all that moves: their momentum is conserved
    double interval; ///< between frames [ps]
    double first_time, last_time;
    size_t frames;
    double *mass; ///< shape [beads]; NULL: not all are known
    struct frame_motion path;
    struct motion motion;
    struct etd etd;
    struct sample_series temperature; ///< kinetic, of the beads [K]
};

/// Prepare for frames whose first two are given, of beads in a box of that density, and boxes of at
/// least that height.
/// Nothing but the temperature begins, and `begun` stays false, if that is wanted, or if the frames
/// have no times.
/// Fails: BAD_INPUT for velocities that are asked for and missing, or a window that is too short;
/// NO_MEMORY.
enum status mf_measured_motion_begin(struct measured_motion *motion,
                                     const struct measured_motion_plan *plan,
                                     const struct mapping *mapping,
                                     const struct trajectory_frame *first,
                                     const struct box_vectors *box, double height) MUST_USE;

/// Add the next frame, whose beads are also told as a configuration. Fails: BAD_INPUT, naming the
/// frame, if it is not an interval after the one before, has no velocities where others have, or a
/// box too small; NO_MEMORY.
enum status mf_measured_motion_add(struct measured_motion *motion,
                                   const struct trajectory_frame *beads,
                                   const struct configuration *configuration) MUST_USE;

/// Take the mean interval of all frames for that of results.
void mf_measured_motion_end(struct measured_motion *motion);

void mf_measured_motion_clear(struct measured_motion *motion);
