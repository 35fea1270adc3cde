// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Discs sorted into cells, a grid for each class of sizes.
///
/// A class holds discs whose radii differ by less than a factor, and its cells suit their number
/// and size. A disc looks for others in the cells of each class within its own radius and the
/// largest of the class: with one grid for all sizes, small ones would look as far as large ones
/// do. D. Krijgsman, V. Ogarko and S. Luding, Comput. Part. Mech. 1, 357 (2014).
///
/// Cells lie in rows along the second axis, and what is sorted follows the rows: all that is around
/// a disc in a row is contiguous, but for the ends of the box. In three dimensions the cells are
/// columns along z, so that a sphere also looks at those far above it.
#pragma once

#include "system/cells.h"
#include "system/particles.h"

#include <stdbool.h>

enum { SOFT_DISCS_MAX_CLASSES = 12, SOFT_DISCS_BLOCK = 8 };

struct soft_discs_class {
    double largest; ///< radius in it [λ]
    size_t count;
    int rows, columns;
    size_t first_cell; ///< of its rows · columns among the cells of all classes
};

/// Discs that follow each other in a row of cells, and look around together.
struct soft_discs_block {
    uint32_t first, count; ///< places; at most SOFT_DISCS_BLOCK
    int row;
};

/// Discs in the order of their cells. Kernels may read PARTICLES_PADDING places beyond the last.
struct soft_discs_cells {
    size_t count;
    int classes;
    struct soft_discs_class of[SOFT_DISCS_MAX_CLASSES]; ///< from small to large
    size_t blocks;
    struct soft_discs_block *block; ///< shape [blocks], of all classes
    struct cells sorted;            ///< the cells of all classes, one after the other
    int32_t *fraction[3];           ///< box_fraction
    float *radius;                  ///< [λ]
    float *stiffness;               ///< k
    double *position[3];            ///< the same in double precision, or NULL
    double *precise_radius, *precise_stiffness;
};

/// Choose classes and cells for the radii of `particles`, which never change.
/// @param[in] stiffness  shape [count], or NULL: all 1
/// @param[in] precise    keep what the kernels in double precision read, too
/// Fails: NO_MEMORY.
enum status mf_soft_discs_cells_init(struct soft_discs_cells *cells,
                                     const struct particles *particles, bool precise) MUST_USE;
void mf_soft_discs_cells_clear(struct soft_discs_cells *cells);

/// Sort the discs as they are now. Their order depends on that of the particles and on nothing
/// else.
void mf_soft_discs_cells_sort(struct soft_discs_cells *cells, const struct particles *particles);
