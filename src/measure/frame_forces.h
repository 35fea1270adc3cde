// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The normal equations of force matching of a frame (observe/force_equations.h).
///
/// Memory of a thread is that of the equations and of the X of some beads at a time.
#pragma once

#include "measure/frame_pairs.h"
#include "measure/measured_molecules.h"
#include "observe/force_equations.h"
#include "trajectory/frame.h"

/// All zero: forces are not asked for.
struct frame_forces_plan {
    double cutoff; ///< of pairs [nm]
    const struct weighted_density_settings
        *weight; ///< of the local density whose energy makes forces, or NULL; borrowed; its cutoff
                 ///< is no longer than that of pairs
    const struct frame_pairs_plan *pairs;       ///< which are pairs, as of g(r); borrowed
    const struct measured_molecules *molecules; ///< whose terms there are, or none; borrowed
    struct force_equations equations;           ///< of all frames
    bool *pushed; ///< a bead had a force in one of the frames; shape [beads]
};

/// Choose the nodes: those of pairs as wide as the bins of g(r), or wider where there would be too
/// many; those of terms around where they are in a frame. Fails: BAD_INPUT for too many curves, or
/// forces that are of no use: all zero, or all of a type; NO_MEMORY. Tested: test_frame_forces.
/// @param[in] beads  a frame of them, with forces
/// @param[in] place    its mf_frame_box_places
/// @param[in] density  its mf_frame_pairs_weigh, if there is a weight
enum status mf_frame_forces_begin(struct frame_forces_plan *plan, const struct box_vectors *box,
                                  const struct trajectory_frame *beads, int32_t *const place[3],
                                  const double *density) MUST_USE;
void mf_frame_forces_end(struct frame_forces_plan *plan);

/// Memory of one thread, used again for every frame; all zero is none.
struct frame_forces {
    struct cell_pairs search;
    const double *density;           ///< of the frame
    double *way;                     ///< X: shape [beads at a time, 3, unknowns]
    size_t begin, end;               ///< beads of which it is
    double *gram, *product, *virial; ///< of the frame
    double square;                   ///< Σ F²
};

void mf_frame_forces_clear(struct frame_forces *forces);

/// Find G, b and w of a frame. Fails: NO_MEMORY. Threads: one a struct frame_forces. Tested:
/// test_frame_forces, against the obvious sums.
enum status mf_frame_forces_find(struct frame_forces *forces, const struct frame_forces_plan *plan,
                                 const struct box_vectors *box,
                                 const struct trajectory_frame *beads, int32_t *const place[3],
                                 const double *density) MUST_USE;
