// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a map of atoms to beads asks for: a JSON file, or one bead a residue.
///
///     {"beads": {"CH3": {"residue": "MET", "atoms": "C H1 H2 H3"},
///                "OH":  {"residue": "MET", "atoms": "O H"}},
///      "masses": {"C": 12.011}}
#pragma once

#include "base/fields.h"
#include "base/status.h"
#include "trajectory/structure.h"

enum { MAPPING_MAX_BEADS = 60, MAPPING_MAX_MASSES = 60, MAPPING_MAX_RESIDUES = 10000 };

enum mapping_centre { MAPPING_CENTRE_OF_MASS, MAPPING_CENTRE_OF_GEOMETRY };

/// One kind of bead.
struct mapping_entry {
    char key[FIELD_TEXT_SIZE];     ///< its name in the file
    char type[FIELD_TEXT_SIZE];    ///< of the bead; "" is the name of its residue
    char residue[FIELD_TEXT_SIZE]; ///< ""; any
    char atoms[FIELD_TEXT_SIZE];   ///< their names; "": all of the residue
    int64_t first, last, size; ///< or a bead for each `size` atoms of first … last, from 1; 0: none
    int centre;                ///< enum mapping_centre
};

/// An atom of a molecule's bead: of which of the molecule's residues, and its weight in a mean.
struct mapping_member {
    size_t residue; ///< from 0
    char name[STRUCTURE_NAME];
    double weight;
};

/// A bead of a molecule.
struct mapping_part {
    char name[STRUCTURE_NAME], type[STRUCTURE_NAME];
    size_t first, count; ///< in `member` of the plan
};

/// Beads of a molecule that is one or several residues after each other.
struct mapping_molecule {
    char name[STRUCTURE_NAME];
    size_t residues, first_residue; ///< in `residue` of the plan
    size_t parts, first_part;       ///< in `part` of the plan
};

struct mapping_plan {
    char file[FIELD_TEXT_SIZE]; ///< for messages
    struct mapping_entry *entry;
    size_t entries;
    struct mapping_molecule *molecule; ///< of VOTCA's maps (votca_map.h), in place of entries
    char (*residue)[STRUCTURE_NAME];   ///< their names; "": any
    struct mapping_part *part;
    struct mapping_member *member;
    size_t molecules, residues, parts, members;
    size_t capacity[4]; ///< of these four
    struct mapping_mass {
        char name[STRUCTURE_NAME];
        double mass;
    } mass[MAPPING_MAX_MASSES];
    size_t masses;
    bool ignores_rest; ///< atoms that no entry names are left out; else they are a fault
};

/// Of an entry and of the file, for `describe`.
extern const struct field mf_mapping_plan_bead_fields[], mf_mapping_plan_fields[];

/// One bead a residue, by its centre of mass. Fails: NO_MEMORY.
enum status mf_mapping_plan_default(struct mapping_plan *plan) MUST_USE;

/// Fails: BAD_INPUT with all faults of the file; IO; NO_MEMORY. Tested: test_mapping.
enum status mf_mapping_plan_read(struct mapping_plan *plan, const char *file) MUST_USE;

void mf_mapping_plan_clear(struct mapping_plan *plan);
