// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a data file of LAMMPS says of bonds, angles and dihedrals (manual, read_data): its
/// sections as they stand there. Atoms are read by trajectory/lammps_data.h.
#pragma once

#include "base/status.h"
#include "system/topology.h"
#include "trajectory/frame.h"
#include "trajectory/structure.h"

enum { LAMMPS_MAX_NUMBERS = 8 }; ///< of a line of coefficients

/// A line of "Bond Coeffs" and the like.
struct lammps_coefficient {
    size_t line; ///< 0: there is none
    char style[TOPOLOGY_NAME_SIZE];
    int count;
    double number[LAMMPS_MAX_NUMBERS];
};

/// What stands in a file beside the terms of the structure.
struct lammps_terms {
    size_t *line[BONDED_KINDS]; ///< shape [terms]: of each
    int64_t types[BONDED_KINDS];
    struct lammps_coefficient *coefficient[BONDED_KINDS]; ///< shape [types + 1], by type
};

/// Read all sections of a file that has been fetched. Must be cleared, also after a failure. In a
/// time that grows as n log n.
/// @param[in] structure  what the trajectory's reader made of it
/// Fails: BAD_INPUT with file and line for a section or an item of the header that is not known, a
/// term that stands there twice, other numbers of them than the header says; NO_MEMORY.
enum status mf_lammps_terms_read(struct lammps_terms *terms, const struct structure *structure,
                                 const struct trajectory_frame *frame) MUST_USE;
void mf_lammps_terms_clear(struct lammps_terms *terms);
