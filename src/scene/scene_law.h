// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Φ or ω of a scene: the curves that its file names, and their table.
///
/// {"law": …} is one curve for all pairs; a mixture may have one for each pair type,
/// {"A-A": {"law": …}, "A-B": {"law": …}, …}.
#pragma once

#include "curves/table.h"
#include "io/json.h"
#include "io/json_write.h"
#include "io/units.h"
#include "system/composition.h"

/// Owns its curves and its table.
struct scene_law {
    int curves; ///< 0: none; 1: for all pairs; else one for each pair type
    struct curve curve[COMPOSITION_MAX_PAIRS]; ///< family NULL: none
    struct table table;                        ///< of the curves, if there are any
};

/// mf_table_init_potential or mf_table_init_omega.
typedef enum status scene_law_table(struct table *table, const struct curve *curve);

/// Read the curves at `key` of `parent`; an absent object leaves none, and so do types that could
/// not be read (a composition of none). Faults, among them pairs that are missing, unknown or twice
/// there, go to the document. Fails: NO_MEMORY.
enum status mf_scene_law_read(struct scene_law *law, struct json_object *parent, const char *key,
                              const struct curve_family *const *list,
                              const struct composition *composition,
                              const struct units *units) MUST_USE;

/// Make the table of the curves. Fails: NO_MEMORY.
enum status mf_scene_law_tabulate(struct scene_law *law, scene_law_table *tabulate) MUST_USE;

/// The curve of a pair type, or NULL.
const struct curve *mf_scene_law_curve(const struct scene_law *law, int pair);

void mf_scene_law_clear(struct scene_law *law);
void mf_scene_law_write(const struct scene_law *law, const struct composition *composition,
                        struct json_writer *writer, const char *key);

/// Add the table to the digest of a checkpoint.
void mf_scene_law_digest(const struct scene_law *law, uint64_t *digest);

/// Read {"law": …} at `key` into a curve; an absent object or "none" leaves it empty. `units`
/// convert VOTCA's tables.
enum status mf_scene_read_curve(struct curve *curve, struct json_object *parent, const char *key,
                                const struct curve_family *const *list,
                                const struct units *units) MUST_USE;
void mf_scene_write_curve(const struct curve *curve, struct json_writer *writer, const char *key);

/// The first two columns of a file, of these reduced units, as points whose x grows from `min`
/// or above.
/// @param[out] x, value  shape [count], which the caller frees, also after a failure
/// Fails: BAD_INPUT, IO, NO_MEMORY.
enum status mf_scene_read_columns(const char *file, const char *const unit[2], double min,
                                  const struct units *units, double **x, double **value,
                                  size_t *count) MUST_USE;

/// @name Objects whose keys are names of pair types, {"A-A": {…}, "A-B": {…}}: of laws and of
/// targets Find what the file calls each pair type, "A-B" or "B-A": key[pair], NULL where it has no
/// member. Of the members only objects are looked at, since settings may stand beside. One that
/// names no pair, or names one again, is a fault that lists the names; returns false then. Tested:
/// test_fit_molecules, test_bad_input.
bool mf_scene_pair_names_find(struct json_object *object, const struct composition *composition,
                              const char *key[COMPOSITION_MAX_PAIRS]);

/// Refuse a pair that is named where all are alike, in one line that tells what to write instead.
/// Returns whether there was one.
bool mf_scene_pair_names_refuse(struct json_object *object, const struct composition *composition,
                                const char *instead);
