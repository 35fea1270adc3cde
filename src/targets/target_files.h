// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "target" of a run file: the measured observables that a fit is to reproduce.
#pragma once

#include "inversion/normalisation.h"
#include "observe/kirkwood_buff_observable.h"
#include "observe/rdf_observable.h"
#include "targets/target_curve.h"
#include "targets/target_etd.h"
#include "targets/target_forces.h"
#include "targets/target_groups.h"
#include "targets/target_kirkwood_buff.h"
#include "targets/target_pairs.h"
#include "targets/target_record.h"

extern const struct field mf_target_files_use_fields[];

/// All readers, NULL-terminated, and that of a kind.
extern const struct target_record *const mf_target_records[];
const struct target_record *mf_target_record(int kind);

struct target_files {
    bool given[TARGETS];
    struct composition composition;     ///< of the scene
    struct normalisation normalisation; ///< by which g(r) of all that do not say theirs are divided
    void *own[TARGETS];                 ///< what the reader of each kind keeps
    /// Of the observables whose targets say them, by their places in the list; else NULL.
    void *settings[OBSERVABLES_MAX];
    struct target_forces forces;
    struct target_use {
        double weight; ///< 0: by the errors
        int fitted;    ///< 0: only compared with the result
    } use[TARGETS];
};

/// @name What was read of a kind, empty if it is not given
static inline const struct target_pairs *target_files_rdf(const struct target_files *files) {
    return files->own[TARGET_RDF];
}

/// g(r) of beads of different molecules.
static inline const struct target_pairs *
target_files_intermolecular(const struct target_files *files) {
    return files->own[mf_rdf_intermolecular_kind()];
}

static inline const struct target_etd *target_files_etd(const struct target_files *files) {
    return files->own[TARGET_ETD];
}

/// Of bonds, angles or dihedrals.
static inline const struct target_groups *target_files_groups(const struct target_files *files,
                                                              int order) {
    return files->own[mf_bonded_distribution_kind(order)];
}

static inline const struct target_kirkwood_buff *
target_files_kirkwood_buff(const struct target_files *files) {
    return files->own[mf_kirkwood_buff_kind()];
}

/// Of a kind that is a curve.
static inline const struct target_curve *target_files_curve(const struct target_files *files,
                                                            int kind) {
    return files->own[kind];
}

/// Read the object "target" of a run file. Faults go to the document. Fails: NO_MEMORY.
enum status mf_target_files_read(struct target_files *files, struct json_object *root,
                                 const struct target_scene *scene) MUST_USE;
void mf_target_files_clear(struct target_files *files);

/// Let follow what does from parameters of g(r), and from a composition, that were chosen after the
/// targets were read. Faults go to the document of `root`. Fails: NO_MEMORY.
enum status mf_target_files_complete(struct target_files *files, struct json_object *root,
                                     const struct target_scene *scene) MUST_USE;

/// Take out the target of a group of bonds, angles or dihedrals. Fails: NO_MEMORY.
enum status mf_target_files_drop(struct target_files *files, int order, size_t group) MUST_USE;
void mf_target_files_write(const struct target_files *files, struct json_writer *writer);

/// Add what was read from files to the digest of a checkpoint.
void mf_target_files_digest(const struct target_files *files, uint64_t *digest);

/// Give the target of a group of bonds, angles or dihedrals these bins, of which its own are some,
/// and measure it in them. What it has not seen has p = 0 and the error of its nearest bin. Fails:
/// NO_MEMORY.
enum status mf_target_files_widen(struct target_files *files, int order, size_t group,
                                  const struct bonded_bins *bins) MUST_USE;

/// Divide g(r) by its normalisation: what the file says, else what mf_normalisation_find makes of
/// the target in this box, and 1 of beads that are `joined` to molecules, of which it knows
/// nothing. If the file says some of a mixture's, the others are 1. That of different molecules is
/// divided by what the file says alone. Also what is not known of it, for the fit. Fails:
/// NO_MEMORY.
enum status mf_target_files_normalise(struct target_files *files, const struct box *box,
                                      bool joined) MUST_USE;

/// The targets of the scene: those to be fitted, and all. With `moves`, D is among
/// those to be compared even if no value is given, so that a result knows its own, if another
/// target says in what window.
void mf_target_files_targets(struct target_files *files, bool moves, struct targets *fitted,
                             struct targets *compared);

/// BAD_INPUT with the time steps that would do if an interval is not a whole number of steps.
enum status mf_target_files_check_steps(const struct target_files *files,
                                        double time_step) MUST_USE;

/// The table in which a fit shows part n of a kind beside its result; false beyond the last.
bool mf_target_files_table(const struct target_files *files, int kind, size_t n,
                           struct target_table *table);
