// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Maps of VOTCA, <cg_molecule> in XML: beads of molecules, by their atoms RESIDUE:NAME:ATOM
/// and weights, and the bonds, angles and dihedrals of <cg_bonded>. Several files are named as
/// VOTCA does, "a.xml;b.xml".
#pragma once

#include "base/status.h"
#include "trajectory/mapping_plan.h"

#include <stdbool.h>

enum { VOTCA_MAP_PATH_SIZE = 4096 };

/// Whether files are called as maps of VOTCA are: the last ends with ".xml".
bool mf_votca_map_is(const char *files);

/// Take the next file of "a.xml;b.xml" into `file` of `size` bytes; false if there is none.
bool mf_votca_map_next(const char **files, char *file, size_t size);

/// Read maps into a plan, which leaves out all other atoms. Fails: BAD_INPUT with file and line;
/// IO; NO_MEMORY. Tested: test_votca_map.
enum status mf_votca_map_read(struct mapping_plan *plan, const char *files) MUST_USE;

/// What <cg_bonded> of maps says, as JSON that --molecules takes, "molecules" and the types of
/// single beads; NULL if no map has any. @param[out] json  to be freed by mf_memory_free
/// Fails: as mf_votca_map_read.
enum status mf_votca_map_bonds(char **json, const char *files) MUST_USE;
