// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The second line of a frame of extended XYZ: key=value, values with blanks being quoted.
#pragma once

#include "trajectory/words.h"

#include <stdbool.h>

/// What columns of atoms mean to us.
enum xyz_column {
    XYZ_NAME,
    XYZ_POSITION, ///< three columns
    XYZ_VELOCITY, ///< three columns
    XYZ_MOMENTUM, ///< three columns, in the unit of ASE
    XYZ_MASS,
    XYZ_ID,
    XYZ_MOLECULE,
    XYZ_COLUMNS,
};

struct xyz_comment {
    double box[3][3];        ///< in the file's unit; 0: none
    bool periodic[3];        ///< all, unless the file says otherwise
    double time;             ///< in the file's unit; NAN: not said
    int64_t step;            ///< −1: not said
    int column[XYZ_COLUMNS]; ///< where each begins; −1: nowhere
    size_t columns;          ///< of an atom, at least
    char units[32];          ///< as mf_trajectory_unit_names has them; "": not said
};

/// Read a comment; a plain one says nothing, and gives the columns of plain XYZ.
/// @return NULL, or what is wrong with it. Tested: test_trajectory_text.
const char *mf_xyz_comment_read(struct xyz_comment *comment, const char *line);
