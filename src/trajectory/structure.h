// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the atoms of a trajectory are, which does not change with time.
#pragma once

#include "base/status.h"
#include "trajectory/words.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { STRUCTURE_NAME = 16 };

/// What a format does not have is 0, "" or NAN.
struct structure_atom {
    char name[STRUCTURE_NAME];         ///< "OW"; else its element or the number of its type
    char residue_name[STRUCTURE_NAME]; ///< "SOL"
    char element[STRUCTURE_NAME];      ///< "O", as the file says it
    char type_name[STRUCTURE_NAME];    ///< of its type in a topology, where it is called otherwise
    char chain;
    int64_t residue_number; ///< as in the file, where it may begin again
    int64_t id, molecule, type;
    double mass;    ///< [u]; NAN if not known
    size_t residue; ///< 0 … residues − 1
};

/// What stands in the place of names: a file of LAMMPS has elements or types for them.
enum structure_names { STRUCTURE_NAMES, STRUCTURE_ELEMENTS, STRUCTURE_TYPES };

/// Bonds, angles and dihedrals, of 2, 3 and 4 atoms.
enum { STRUCTURE_TERM_KINDS = 3 };

/// All terms of a kind, by the places of their atoms.
struct structure_terms {
    size_t count;
    uint32_t *atom; ///< shape [count, 2 + kind]
    uint32_t *type; ///< shape [count]; NULL: the file has no types of terms
    size_t types;
    char (*name)[STRUCTURE_NAME]; ///< shape [types]
};

/// What its format, or the file, knows of atoms.
struct structure {
    size_t atoms;
    struct structure_atom *atom; ///< shape [atoms], in the order of every frame's positions
    bool has_names, has_residues, has_elements, has_molecules, has_types, has_ids, has_masses;
    enum structure_names names;                         ///< what they are, if it has them
    struct structure_terms terms[STRUCTURE_TERM_KINDS]; ///< as far as a format reads them
    size_t residues; ///< 0 if neither residues nor molecules are known
};

/// Whether it tells what atoms are, and not only where.
static inline bool structure_says_what(const struct structure *structure) {
    return structure->has_names || structure->has_residues || structure->has_elements ||
           structure->has_molecules || structure->has_types || structure->has_masses;
}

/// `atoms` atoms of which nothing is known. Fails: NO_MEMORY.
enum status mf_structure_init(struct structure *structure, size_t atoms) MUST_USE;

void mf_structure_clear(struct structure *structure);

/// Sort the atoms by their ids. Fails: BAD_INPUT, without a place, if two have the same.
enum status mf_structure_sort(struct structure *structure) MUST_USE;

/// Number the residues: runs of atoms with the same number, name, chain and molecule; where there
/// are no residues, the molecules, wherever their atoms stand in the file. An atom of molecule 0 is
/// on its own. Fails: NO_MEMORY. Tested: test_structure.
enum status mf_structure_number_residues(struct structure *structure) MUST_USE;

/// Make a molecule of all atoms that bonds join, by their places; an atom without a bond is on its
/// own. Fails: BAD_INPUT, without a place, for a bond of an atom that is not there; NO_MEMORY.
/// Tested: test_structure.
enum status mf_structure_join(struct structure *structure, const uint32_t (*bond)[2],
                              size_t bonds) MUST_USE;

/// Index of the atom with that id; `structure->atoms` if there is none. Ids grow with the index.
size_t mf_structure_find(const struct structure *structure, int64_t id);

/// Whether `other`, of a trajectory, can be the same atoms: as many, and no name, residue or id is
/// another where both know it; names, elements and types are not compared with each other. Fails:
/// BAD_INPUT, naming both files and the first atom that differs.
enum status mf_structure_check_same(const struct structure *structure, const char *file,
                                    const struct structure *other, const char *other_file) MUST_USE;
