// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is measured of frames that are equally far apart in time: motion and escape times.
#pragma once

#include "observe/etd.h"
#include "observe/motion.h"
#include "observe/sample_series.h"
#include "trajectory/frame.h"
#include "trajectory/mapping.h"

/// Where beads have gone, across the faces of a box that may change.
///
/// From frame to frame a bead goes to the nearest image of its fractions s of the box; the path is
///   r(t_n) = r(t_0) + Σ_n (s_n − s_{n−1}) · ½ (H_{n−1} + H_n),
/// H being the box's vectors. In a constant box this is the displacement itself. Where a barostat
/// changes the box it is the integral of H ds/dt, the velocity relative to the flow that scales
/// positions with the box: the momenta of constant-pressure dynamics, and what diffuses. (Unwrapped
/// positions themselves would be scaled by all that the box has changed since: S. von Bülow,
/// J. T. Bullerjahn and G. Hummer, J. Chem. Phys. 153, 021101 (2020).)
///
/// Where both frames tell the images of the box, whole boxes are added to the way to the nearest.
/// Elsewhere a bead must not go half a height of the box between two frames, and it is counted how
/// many came near that. Images are not believed in a frame in which most beads that would have
/// gone around the box are found where they were: of a run that was begun again, or of a file that
/// calls wrapped positions unwrapped.
///
/// Velocities may be those of the frames, or differences of places around a frame,
///   v_n = (r_{n+1} − r_{n−1}) / (2 Δt),
/// a mean of v over [−Δt, Δt]: their VACF is the true one averaged with a triangle of half-width
/// 2 Δt, lower at short times, with the same integral. States are then reported one frame later.
struct measured_path {
    size_t beads;
    const double *mass; ///< shape [beads] [u]; NULL: all alike; borrowed
    bool together;      ///< states are relative to the centre of mass
    bool differences;
    double interval;   ///< between frames [ps]
    int32_t *place[3]; ///< of the frame before
    double box[3][3];  ///< likewise [nm]
    double *path[3];   ///< shape [3, beads] each: two frames before, one before, now [nm]
    double *state;     ///< shape [2, 3, beads]: positions [nm], velocities [nm/ps]
    double *boxes;     ///< shape [2, 3, beads]: fractions of the box, now and in the frame before
    bool unwrapped;    ///< the frame before tells them
    size_t frames;
    uint64_t steps, far; ///< to nearest images alone along vectors of the box, and near half of it
};

/// Fails: NO_MEMORY.
enum status mf_measured_path_init(struct measured_path *motion, size_t beads) MUST_USE;

void mf_measured_path_clear(struct measured_path *motion);

/// Follow the beads to the next frame. @return the state of this frame, with differences of the one
/// before; NULL if there is none yet. Tested: test_measured_path.
const double *mf_measured_path_add(struct measured_path *motion,
                                   const struct trajectory_frame *beads, int32_t *const place[3]);

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
    bool is_kinetic; ///< beads have masses, and move as these do
    bool is_thermal; ///< velocities tell the temperature, too: no bonds of fixed length hold beads
    bool has_velocities; ///< a frame has
    bool together;       ///< beads are all that moves: their momentum is conserved
    double interval;     ///< between frames [ps]
    double first_time, last_time;
    size_t frames;
    double *mass; ///< shape [beads]; NULL: not all are known
    struct measured_path path;
    struct motion motion;
    struct etd etd;
    struct sample_series temperature; ///< kinetic, of the beads [K]
    size_t *type;                     ///< of each bead; NULL: velocities tell no temperature
    struct sample_series of_type;     ///< kinetic, of the beads of each type [K]
};

/// Prepare for frames of which the first are given, two or all there are, of beads in a box of that
/// density, and boxes of at least that height.
/// Nothing but the temperature begins, and `begun` stays false, if that is wanted, if there is one
/// frame, or if the frames have no times.
/// Fails: BAD_INPUT for velocities that are asked for and missing, or a window that is too short;
/// NO_MEMORY.
enum status mf_measured_motion_begin(struct measured_motion *motion,
                                     const struct measured_motion_plan *plan,
                                     const struct mapping *mapping,
                                     const struct trajectory_frame *first, size_t count,
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
