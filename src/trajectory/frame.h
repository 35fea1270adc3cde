// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One frame of a trajectory, whose arrays are used again for the next.
#pragma once

#include "base/status.h"
#include "system/box_vectors.h"
#include "trajectory/source.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// All zero is a frame that has not been read. Positions are as the file has them: whole molecules
/// may reach out of the box, and atoms may be in any of its images.
struct trajectory_frame {
    size_t number;         ///< in the file, from 0; of arrays of the caller's from 1
    int64_t step;          ///< of the simulation that wrote it; −1: not known
    double time;           ///< [ps]; NAN: not known
    bool has_box;          ///< else `box` is 0 and nothing is periodic
    bool has_velocities;   ///< in this frame
    bool has_forces;       ///< in this frame, and asked for
    bool unwrapped;        ///< positions tell how often an atom has gone around the box
    bool periodic[3];      ///< along the vectors of the box
    double box[3][3];      ///< its vectors a, b, c, one a row [nm]
    size_t atoms;          ///< as the trajectory's structure has
    double (*position)[3]; ///< shape [atoms, 3] [nm]
    double (
        *velocity)[3]; ///< shape [atoms, 3] [nm/ps]; what it holds means nothing without velocities
    double (*force)[3];   ///< shape [atoms, 3] [kJ/mol/nm]; likewise without forces
    const char *file;     ///< what follows is the readers' own
    uint64_t first_byte;  ///< of the frame in the file
    size_t first_line;    ///< lines of the file before the frame
    struct bytes raw;     ///< the frame as it stands in the file
    struct bytes scratch; ///< of a decoder
    size_t capacity, speed_capacity, force_capacity; ///< atoms that the arrays could hold
};

/// Room for positions, and for velocities if `velocities`, which is what has_velocities becomes;
/// `unwrapped` and has_forces become false.
/// Fails: NO_MEMORY.
enum status mf_frame_reserve(struct trajectory_frame *frame, size_t atoms,
                             bool velocities) MUST_USE;

/// After that: room for forces, which the frame then has. Fails: NO_MEMORY.
enum status mf_frame_reserve_forces(struct trajectory_frame *frame) MUST_USE;

void mf_frame_clear(struct trajectory_frame *frame);

/// The box with edges of these lengths [nm] and angles [°] α (b, c), β (a, c), γ (a, b): a along x,
/// b in the plane of x and y. False if there is no such box.
bool mf_frame_box_of_angles(struct trajectory_frame *frame, const double length[3],
                            const double angle[3]);

/// A box has a volume, or it is none; what is periodic without one is not.
void mf_frame_set_box(struct trajectory_frame *frame, const double box[3][3]);

/// Reciprocal vectors of the box, without 2π, one a row: a difference of positions times a row is
/// its fraction of that vector of the box. 0 for those that are not periodic.
void mf_frame_reciprocal(const struct trajectory_frame *frame, double reciprocal[3][3]);

/// place = the image of `position` nearest to `place`, given mf_frame_reciprocal: right if it is
/// nearer than half the least height of the box.
void mf_frame_step_to(const struct trajectory_frame *frame, double reciprocal[3][3],
                      const double position[3], double place[3]);

/// BAD_INPUT for a place in a frame of text, whose lines end with NUL: "file:line: frame 3: …".
enum status mf_frame_fail_line(const struct trajectory_frame *frame, const char *at,
                               const char *format, ...) __attribute__((format(printf, 3, 4)));

/// BAD_INPUT for a byte of a frame, counted from its first one: "file: frame 3, byte 1234: …".
enum status mf_frame_fail_byte(const struct trajectory_frame *frame, size_t at, const char *format,
                               ...) __attribute__((format(printf, 3, 4)));

/// The line after the one that `line` is in; NULL after the frame's last.
const char *mf_frame_next_line(const struct trajectory_frame *frame, const char *line);

/// "… t= 0.5 step= 250" of a title [ps]: the words of GROMACS.
void mf_frame_read_title(struct trajectory_frame *frame, const char *title);

// The box of a frame, and the places of beads in it (system/box_vectors.h).

/// Fails: BAD_INPUT, naming the frame, if it has no box or is not periodic in all of it.
enum status mf_frame_box_find(struct box_vectors *box,
                              const struct trajectory_frame *frame) MUST_USE;

/// Fails: BAD_INPUT, naming the frame, if `range` is beyond half the least height; `what` says
/// whose range it is. Tested: test_frame_pairs.
enum status mf_frame_box_check_range(const struct box_vectors *box,
                                     const struct trajectory_frame *frame, double range,
                                     const char *what) MUST_USE;

/// Fractions of the positions; place[i] has shape [frame->atoms]. Fails: BAD_INPUT, naming frame
/// and bead, if one is so many boxes away that its place in a box is lost. Tested:
/// test_frame_pairs.
enum status mf_frame_box_places(const struct box_vectors *box, const struct trajectory_frame *frame,
                                int32_t *const place[3]) MUST_USE;

/// How far the atoms of a frame spread along each vector, in boxes: sqrt(12) times their standard
/// deviation, which is 1 of atoms that fill the box evenly, wrapped or not.
void mf_frame_box_spread(const struct box_vectors *box, const struct trajectory_frame *frame,
                         double spread[3]);

/// Whether all atoms have one place along a vector of the box, and fill it along the others, as in
/// two dimensions. Tested: test_measure_limits.
bool mf_frame_box_is_plane(const struct box_vectors *box, const struct trajectory_frame *frame);
