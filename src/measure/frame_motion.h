// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where beads have gone, across the faces of a box that may change.
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
#pragma once

#include "trajectory/frame_box.h"

struct frame_motion {
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
enum status mf_frame_motion_init(struct frame_motion *motion, size_t beads) MUST_USE;

void mf_frame_motion_clear(struct frame_motion *motion);

/// Follow the beads to the next frame. @return the state of this frame, with differences of the one
/// before; NULL if there is none yet. Tested: test_measured.
const double *mf_frame_motion_add(struct frame_motion *motion, const struct trajectory_frame *beads,
                                  int32_t *const place[3]);
