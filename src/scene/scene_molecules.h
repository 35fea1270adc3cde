// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "molecules" of a scene, and the "bonds", "angles" and "dihedrals" that hold them together.
///
/// "bonds": {"backbone": {"law": "harmonic", …}, …}: groups under names that the file chooses,
/// each with its law; likewise "angles" and "dihedrals". "molecules": {"hexane": {"count": 300,
/// "chain": {"type": "A", "length": 3, "bond": "backbone"}}, "ring": {"count": 10, "beads": ["A",
/// "A", "A"], "bonds": {"backbone": [[1, 2], [2, 3], [3, 1]]}}}: kinds, each a chain or a graph.
#pragma once

#include "forces/molecules.h"
#include "scene/scene_law.h"

enum { SCENE_MOLECULES_WARNING_SIZE = 1024 };

/// How a file tells of a kind, which is written so, too.
struct scene_molecule {
    bool is_chain, of_one_type;
    int group[BONDED_KINDS]; ///< of a chain; −1: none
};

/// Groups whose law a fit looks for, so that the scene does not say it.
struct scene_fitted {
    int count[BONDED_KINDS];
    char name[BONDED_KINDS][MOLECULES_MAX_GROUPS][TOPOLOGY_NAME_SIZE];
    bool given;         ///< by "unknowns"; else what has a target is fitted
    bool count_follows; ///< a count of beads that the scene does not say may be chosen later
    struct json_object from[BONDED_KINDS]; ///< the objects that name them, of those that there are
};

/// Owns the molecules; a scene's interactions borrow them. All zero: there are none.
struct scene_molecules {
    struct molecules molecules;
    struct scene_molecule given[TOPOLOGY_MAX_KINDS];
    bool scattered; ///< a topology's molecules are not in the order of their kinds
    /// Of a data file of LAMMPS, else NULL: mf_lammps_topology_read; and its units.
    size_t *order;
    const char *order_units;
    char warning[SCENE_MOLECULES_WARNING_SIZE]; ///< one line; "" if there is nothing to say
};

/// Fields of a kind, of its "chain", and of a topology's file.
extern const struct field mf_scene_molecule_fields[], mf_scene_chain_fields[],
    mf_scene_file_fields[];

/// Read groups and kinds from the members of `scene`, and number their beads.
/// @param[in]     fitted       groups without a law, or NULL
/// @param[in,out] composition  single beads; the molecules' beads and their types are added
/// Faults go to the document. Fails: NO_MEMORY.
enum status mf_scene_molecules_read(struct scene_molecules *molecules, struct json_object *scene,
                                    const struct scene_fitted *fitted,
                                    struct composition *composition,
                                    const struct units *units) MUST_USE;

/// Read the kinds of `scene` alone, for what is measured: groups are those that the kinds name, and
/// have a law of strength 0; a count may be left out and is then 0. The topology is not completed.
/// @param[in,out] composition  types that are known; those of the beads are added
/// Faults go to the document. Fails: NO_MEMORY.
enum status mf_scene_kinds_read(struct scene_molecules *molecules, struct json_object *scene,
                                struct composition *composition) MUST_USE;
void mf_scene_molecules_clear(struct scene_molecules *molecules);

/// Add to the warning what looks wrong in a kind that can be: terms without bonds, fene bonds whose
/// beads do not repel, pieces that no bonds join. Fails: NO_MEMORY. Tested: cli/test_molecules.
enum status mf_scene_molecules_warn(struct scene_molecules *molecules,
                                    const struct topology_kind *kind) MUST_USE;

/// The same of bonds that thermal motion alone makes longer than half of the box, more often than
/// once in 10^5: a term sees nearest images. Tested: cli/test_molecules.
void mf_scene_molecules_warn_of_box(struct scene_molecules *molecules, const struct box *box,
                                    double temperature);

/// Whether there are any.
static inline bool scene_has_molecules(const struct scene_molecules *molecules) {
    return molecules->molecules.topology.kinds > 0;
}

/// Whether "molecules" names a topology's file, and not kinds, of which one may be called "file".
static inline bool scene_molecules_are_of_file(const struct json_object *molecules) {
    return mf_json_is_member(molecules, "file") && !mf_json_is_object(molecules, "file");
}

/// Write the kinds alone, a share of each one's molecules, or groups with their laws and the kinds.
void mf_scene_kinds_write(const struct scene_molecules *molecules,
                          const struct composition *composition, double share,
                          struct json_writer *writer);
void mf_scene_molecules_write(const struct scene_molecules *molecules,
                              const struct composition *composition, struct json_writer *writer);

/// Add the tables to the digest of a checkpoint.
void mf_scene_molecules_digest(const struct scene_molecules *molecules, uint64_t *digest);

/// Read the groups of one order of terms: {"backbone": {"law": …}, …}, and add those that are
/// fitted, which are not written. Faults go to the document. Fails: NO_MEMORY.
enum status mf_scene_groups_read(struct molecules *molecules, int order, struct json_object *scene,
                                 const struct scene_fitted *fitted,
                                 const struct units *units) MUST_USE;

/// Add the groups that a kind names, each with a law of strength 0. Faults go to the document.
/// Fails: NO_MEMORY.
enum status mf_scene_groups_open(struct molecules *molecules, struct json_object *kind) MUST_USE;

/// A fault for each group that a fit looks for and that no kind of the scene names, where it is
/// named. Those of a topology's file are found later. Fails: NO_MEMORY. Tested:
/// cli/test_fit_molecules.
enum status mf_scene_groups_check_fitted(const struct scene_fitted *fitted,
                                         struct json_object *scene) MUST_USE;

/// Whether a group has no law, since a fit looks for it.
bool mf_scene_groups_are_fitted(const struct molecules_group *group);

/// Let groups of tables without points have a law of strength 0. Fails: NO_MEMORY.
enum status mf_scene_groups_clear_tables(struct molecules *molecules) MUST_USE;

/// Give the groups of a topology the laws that the scene or a fit has for them, which are taken out
/// of `given`: for a table a law of the scene, or none where a fit looks for it; the law of a
/// topology stays, unless "unknowns" names the group. Faults, of groups that are not in the
/// topology, whose law is given twice, and of unknown tables, go to the document.
/// Tested: cli/test_topologies.
void mf_scene_groups_join(struct molecules *molecules, struct molecules *given,
                          const struct scene_fitted *fitted, struct json_object *scene);

void mf_scene_groups_write(const struct molecules *molecules, int order,
                           struct json_writer *writer);

/// Read kinds, groups and types of the file that an object names, by its name a topology of GROMACS
/// or a data file of LAMMPS. The topology is not completed. Faults go to the document. Fails:
/// NO_MEMORY.
/// @param[in,out] molecules  with the groups that the scene or a fit has; those of a data file come
///                           after them
/// @param[in]     scene      the object with the laws of groups
enum status mf_scene_topology_read(struct scene_molecules *molecules, struct json_object *object,
                                   struct json_object *scene, const struct scene_fitted *fitted,
                                   struct composition *composition,
                                   const struct units *units) MUST_USE;
