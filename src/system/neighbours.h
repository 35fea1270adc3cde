// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Verlet list from a cell grid.
///
/// L. Verlet, Phys. Rev. 159, 98 (1967). The list holds every pair nearer than range = cutoff +
/// skin at the time it was built, and stays complete for the cutoff until some particle has moved
/// by half the skin *since the last build* (not since the last step). With a cutoff of 0 there are
/// no pairs, and a build only sorts the particles.
#pragma once

#include "base/parallel.h"
#include "system/cells.h"
#include "system/particles.h"

#include <stdbool.h>

enum neighbours_kind {
    NEIGHBOURS_HALF, ///< each pair once: for forces
    NEIGHBOURS_FULL, ///< each pair from both sides: for single-particle moves
};

/// In a half list the entries of each particle fill rows of this many; what is left over of the
/// last row holds the particle itself. Vector kernels can so go through the list from end to end,
/// which is a fifth faster for short lists than a loop for each particle. The AVX2 vector.
enum { NEIGHBOURS_ROW = 8 };

/// Consecutive planes of cells along the first axis, with their particles and their stretch of the
/// list. Pairs of part n reach into part n + 1 (the first after the last) and no other.
struct neighbours_part {
    int first_plane, last_plane; ///< the latter is the first of the next
    size_t first, last;          ///< particles
    size_t begin, end;           ///< of the list
};

/// Copies of the particles for the search, in rows of cells along the last axis. Both ends of a row
/// have a margin of images of the cells at the other end, so what is around a cell follows each
/// other in memory.
struct neighbours_rows {
    int margin;        ///< cells of images at either end; none if the last axis is short
    bool wrap;         ///< an axis is so short that its nearest images must be looked for
    size_t cells;      ///< of a row, with its margins
    uint32_t *start;   ///< shape [rows, cells + 1]: places where cells begin, and where rows end
    float *place[3];   ///< [λ]
    int32_t *particle; ///< at each place
};

/// Pairs handed over together.
enum { NEIGHBOURS_BATCH = 512 };

/// Parts enough for the processors of a desktop computer.
enum { NEIGHBOURS_MAX_PARTS = PARALLEL_MAX_RING };

struct neighbours {
    enum neighbours_kind kind;
    double range;         ///< cutoff + skin [λ]; 0: no pairs
    double skin;          ///< [λ]
    size_t count;         ///< particles
    size_t *start, *stop; ///< shape [count]: neighbours of k are list[start[k] … stop[k])
    int32_t *list;        ///< indices of particles
    int32_t *owner;       ///< of a half list: the particle to which each row belongs
    size_t list_capacity;
    double entries_each; ///< places of the list for each particle
    double *built[3];    ///< positions at the last build, unwrapped like `position` since then
    struct cells cells;
    int range_cells[3]; ///< the range in cells: neighbours lie within so many
    struct neighbours_rows rows;
    /// 1, or an even number of at least 4, by the cells alone: for mf_parallel_ring.
    int parts;
    struct neighbours_part part[NEIGHBOURS_MAX_PARTS];
};

/// Prepare for particles in `box`. Fails: NO_MEMORY; BAD_INPUT if the box is shorter than twice the
/// cutoff, where the nearest image is no longer the only one in range.
enum status mf_neighbours_init(struct neighbours *neighbours, enum neighbours_kind kind,
                               const struct box *box, size_t count, double cutoff,
                               double skin) MUST_USE;
void mf_neighbours_clear(struct neighbours *neighbours);

/// Whether the cells in range along an axis are all that there are.
static inline bool neighbours_span_axis(const struct neighbours *neighbours, int d) {
    return neighbours->cells.count[d] <= 2 * neighbours->range_cells[d];
}

/// Places on the list of all particles.
size_t mf_neighbours_entries(const struct neighbours *neighbours);

/// Entries without what fills the rows: pairs on a half list, twice as many on a full one.
size_t mf_neighbours_listed(const struct neighbours *neighbours);

/// Wrap and sort the particles in space, then build the list. Fails: NO_MEMORY; UNSTABLE if there
/// is one that cannot be wrapped.
enum status mf_neighbours_sort_and_build(struct neighbours *neighbours,
                                         struct particles *particles) MUST_USE;

/// Build the list for the present order of the particles, as left by an earlier sort, from the
/// positions in `built`; for a restart. Fails: NO_MEMORY.
enum status mf_neighbours_rebuild(struct neighbours *neighbours,
                                  struct particles *particles) MUST_USE;

/// True if some particle has moved by half the skin or more since the last build.
bool mf_neighbours_are_stale(const struct neighbours *neighbours,
                             const struct particles *particles);

/// Pairs in range with the ids of their particles, from which the types in a mixture follow.
struct neighbours_batch {
    size_t count;
    float squared[NEIGHBOURS_BATCH]; ///< distances [λ²]
    uint32_t id_i[NEIGHBOURS_BATCH], id_j[NEIGHBOURS_BATCH];
};

/// mf_neighbours_visit_distances with the ids of the pairs.
void mf_neighbours_visit_pairs(const struct neighbours *neighbours,
                               const struct particles *particles, double range,
                               void (*visit)(void *context, const struct neighbours_batch *batch),
                               void *context);

/// Hand the squared distances [λ²] of all pairs nearer than `range` (≤ the complete range of a half
/// list) to `visit`, in batches, in the order of the list.
void mf_neighbours_visit_distances(
    const struct neighbours *neighbours, const struct particles *particles, double range,
    void (*visit)(void *context, const float *squared_distances, size_t count), void *context);
