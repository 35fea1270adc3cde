// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What stands before the atoms of a frame of a LAMMPS dump: manual, command `dump`.
///
/// LAMMPS writes units and time as items of their own, if asked to. MDAnalysis, which takes nine
/// lines before the atoms, and old versions of OVITO do not read such files. Ours have both behind
/// an item, where no program looks: "ITEM: NUMBER OF ATOMS time=500 units=real".
#pragma once

#include "base/status.h"
#include "trajectory/frame.h"
#include "trajectory/words.h"

/// What a column of atoms may mean to us.
enum lammps_column {
    LAMMPS_ID,
    LAMMPS_TYPE,
    LAMMPS_MOLECULE,
    LAMMPS_ELEMENT,
    LAMMPS_LABEL,
    LAMMPS_MASS,
    LAMMPS_X,                   ///< and y, z after it, as all that follow
    LAMMPS_XS = LAMMPS_X + 3,   ///< as fractions of the box
    LAMMPS_XU = LAMMPS_XS + 3,  ///< with images
    LAMMPS_XSU = LAMMPS_XU + 3, ///< both
    LAMMPS_IX = LAMMPS_XSU + 3, ///< which image
    LAMMPS_VX = LAMMPS_IX + 3,
    LAMMPS_FX = LAMMPS_VX + 3,
    LAMMPS_COLUMNS = LAMMPS_FX + 3,
};

enum { LAMMPS_MAX_COLUMNS = 128 };

struct lammps_dump {
    size_t atoms, columns;
    int column[LAMMPS_COLUMNS]; ///< where each stands; −1: nowhere
    const char *first;          ///< line of the first atom
    const char *units;          ///< where their name stands; NULL: not said
    int64_t step;
    double time; ///< in the file's unit; NAN: not said
    double origin[3], box[3][3];
    bool periodic[3];
};

/// Read all before the atoms, which fetching has found complete.
/// Fails: BAD_INPUT with the line.
enum status mf_lammps_dump_read(struct lammps_dump *dump,
                                const struct trajectory_frame *frame) MUST_USE;

/// Split the line of an atom; word[n] is column n. Fails: BAD_INPUT with the line if it has too
/// few or too many.
enum status mf_lammps_dump_split(const struct lammps_dump *dump,
                                 const struct trajectory_frame *frame, const char *line,
                                 struct word word[LAMMPS_MAX_COLUMNS]) MUST_USE;
