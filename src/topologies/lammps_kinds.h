// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The molecules of a data file of LAMMPS: what terms join, and which of them are alike.
#pragma once

#include "system/topology.h"
#include "trajectory/structure.h"

struct lammps_kinds_source {
    const char *file;
    const struct structure *structure; ///< atoms in the order of ids
    int *const *group;                 ///< shape [BONDED_KINDS][terms]: of each term
    int exclude;
    bool named; ///< types are called as the atoms, and not by their numbers
};

/// Add kinds to a topology, and types and counts of all atoms to a composition, as
/// mf_lammps_topology_read says. In a time that grows as n log n, times the number of kinds.
/// @param[out] order  shape [atoms], to be freed
/// Fails: BAD_INPUT for too many kinds, types or atoms of a molecule; NO_MEMORY.
enum status mf_lammps_kinds_find(const struct lammps_kinds_source *source,
                                 struct topology *topology, struct composition *composition,
                                 size_t **order) MUST_USE;
