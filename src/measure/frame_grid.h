// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A grid of cells in a box of any shape, made anew for every frame.
///
/// Cells are those of fractions of the box's vectors, half a range high or more. What may be within
/// the range of a bead stands in rows of neighbouring cells, one behind the other in memory. Where
/// the range is near half the box, the rows become all beads, and the search that of all pairs.
#pragma once

#include "measure/frame_box.h"

#include <stddef.h>

/// Memory of one thread, used again for every frame; all zero is none.
struct frame_grid {
    size_t beads, room;        ///< beads of a frame, cells that there is room for
    size_t cells[3], reach[3]; ///< cells along the box's vectors, and how far a range reaches
    uint32_t *start;           ///< shape [cells + 1]: first bead of a cell
    uint32_t *cell;            ///< shape [beads]: of each bead
    uint32_t *bead;            ///< shape [beads]: beads in the order of cells
    int32_t *place[3];         ///< shape [beads]: their places, in the order of cells
};

/// Beads begin … end − 1 in the order of cells.
struct frame_row {
    size_t begin, end;
};

/// Who takes pairs: bead `i` and each bead of a row, both in the order of cells.
struct frame_visitor {
    void (*take)(void *context, size_t i, struct frame_row row);
    void *context;
};

/// Sort the beads into cells. @param[in] place  shape [3][beads]: mf_frame_box_places.
/// Fails: NO_MEMORY.
enum status mf_frame_grid_sort(struct frame_grid *grid, double range, const struct frame_box *box,
                               int32_t *const place[3], size_t beads) MUST_USE;

/// Visit all pairs within the range, each once, and others that are somewhat farther. Tested:
/// test_frame_pairs.
void mf_frame_grid_visit(const struct frame_grid *grid, const struct frame_visitor *visitor);

void mf_frame_grid_clear(struct frame_grid *grid);
