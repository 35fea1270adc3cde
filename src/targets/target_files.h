// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "target" of a run file: the measured observables that a fit is to reproduce.
#pragma once

#include "forces/molecules.h"
#include "inversion/normalisation.h"
#include "io/json.h"
#include "io/json_write.h"
#include "io/units_scale.h"
#include "observe/etd.h"
#include "observe/force_equations.h"
#include "observe/kirkwood_buff.h"
#include "observe/observable.h"
#include "observe/rdf_observable.h"
#include "problem/targets.h"
#include "system/components.h"
#include "system/composition.h"
#include "targets/target_bonded.h"
#include "targets/target_rdf.h"

// What each reader keeps --------------------------------------------------------------------------

/// A measured g(r), or in a mixture those of all pair types, {"A-A": {"file": …}, …}: of all pairs,
/// or of beads of different molecules. Tested: test_target_files, test_target_files_mixture.
struct target_pairs {
    size_t pairs;                                    ///< pair types of the scene; 0: not given
    bool has_g[COMPOSITION_MAX_PAIRS];               ///< the others have bins alone
    struct target_rdf member[COMPOSITION_MAX_PAIRS]; ///< of each pair type, in the same bins
    /// Of all, one after the other, in the numbers of the scene: shape [pairs, bins].
    double *g, *error;
    double ends[COMPOSITION_MAX_PAIRS]; ///< where the file of each would end [λ]
    double *given;                      ///< g before it was divided by its normalisation
    double *factor_error;               ///< of that, shape [pairs]
};

static inline const struct rdf_bins *target_pairs_bins(const struct target_pairs *target) {
    return &target->member[0].bins;
}

/// Values of all pair types; 0: the target is not given, or could not be read.
static inline size_t target_pairs_values(const struct target_pairs *target) {
    return target->pairs * target->member[0].bins.count;
}

/// "etd": a measured escape time distribution.
struct target_etd_parameters {
    char file[FIELD_TEXT_SIZE], error_file[FIELD_TEXT_SIZE]; ///< the latter "": no errors given
    int64_t time_column, first_column;                       ///< from 1
    double r_minimum, r_maximum;                             ///< [λ]
};

struct target_etd {
    struct target_etd_parameters parameters;
    struct etd_grid grid;
    double interval;          ///< between times [τ]
    double time;              ///< τ in the units of the file, for messages
    double *survival, *error; ///< shape [times, bins]; NaN: not known; error 0 without errors
    size_t left_out;          ///< cells that are not known
};

/// Read the members of {"file": …}: a time in each row, from 0 on and equally spaced, and from
/// first_column on E of one bin in each column, equal bins from r_minimum to r_maximum. The table
/// of standard errors has the same shape. Cells where either is nan are not known. What `mesofit
/// simulate` writes, etd.tsv and etd_error.tsv, needs no columns.
///
/// Faults (shape, times, values that are no survival probability, …) go to the document and leave
/// the target empty. Fails: NO_MEMORY. Tested: test_target_etd, test_simulate_pairs.
enum status mf_target_etd_read(struct target_etd *target, struct json_object *object) MUST_USE;
void mf_target_etd_clear(struct target_etd *target);

/// Targets of one kind for the groups of a scene, {"backbone": {"file": …}, …}, by the numbers of
/// the groups.
struct target_groups {
    int order;
    size_t groups; ///< of the scene; 0: the target is not given
    char name[MOLECULES_MAX_GROUPS][TOPOLOGY_NAME_SIZE];
    struct target_bonded *member;           ///< shape [groups]
    size_t first[MOLECULES_MAX_GROUPS + 1]; ///< value of each among those of all
    double *value, *error;                  ///< of all members, one after the other
    size_t *block, blocks;                  ///< their blocks (mf_targets_blocks), and the end
};

/// Whether a group of the scene has a target.
static inline bool target_groups_have(const struct target_groups *groups, size_t group) {
    return group < groups->groups && groups->member[group].bins.count > 0;
}

/// A measured curve: for every target that needs no reader of its own.
/// x grows from row to row; times begin at 0 and are equally spaced to the digits of the file.
/// Tested: test_target_files.
struct target_curve {
    struct target_curve_parameters {
        char file[FIELD_TEXT_SIZE];
        int64_t x_column, value_column,
            error_column; ///< from 1; value_column 0, error_column −1: by name; error_column 0:
                          ///< none
    } parameters;
    size_t points;             ///< 0: not given
    double interval;           ///< between times [τ]; 0: of a curve that is no function of time
    double time;               ///< τ in the units of the file, for messages
    double *x, *value, *error; ///< shape [points]
};

/// BAD_INPUT with the time steps that would do if the interval between the times of a file [τ] is
/// not a whole number of steps to 0.1 %: what moves is measured as often as it was.
/// @param[in] time  τ in the units of the file, for messages
enum status mf_target_curve_check_steps(const char *file, double interval, double time,
                                        double time_step) MUST_USE;

/// A measured number: the pressure, or D.
struct target_number {
    double value, error;
    double window; ///< of D: the slope of the MSD over its second half; 0: of other targets [τ]
};

/// "kirkwood_buff": a value and its error of each pair of components (system/components.h) that is
/// named, {"A-B": {"value": …, "error": …}, …}; of one component {"value": …, "error": …}.
/// Tested: test_target_files.
struct target_kirkwood_buff {
    struct composition components;
    size_t pairs; ///< of the components; 0: not given
    /// By the numbers of the pairs; NaN: not named.
    double value[COMPOSITION_MAX_PAIRS], error[COMPOSITION_MAX_PAIRS];
};

/// "forces": the equations of force matching that `measure --forces` has written. They are no
/// observable, and nothing is compared with them.
struct target_forces {
    bool given;
    struct target_forces_files {
        char file[FIELD_TEXT_SIZE], gram_file[FIELD_TEXT_SIZE];
    } files;
    struct force_equations equations; ///< in reduced units
};
extern const struct field mf_target_forces_fields[];

// Readers -----------------------------------------------------------------------------------------

struct target_files;

/// What targets are read for.
struct target_scene {
    const struct box *box;
    const struct composition *composition; ///< no types: not known
    const struct molecules *molecules;     ///< or NULL
    const struct units *units;             ///< of the scene: they convert VOTCA's tables
};

/// Some values of a target that stand in one table beside the result.
struct target_table {
    char name[128];                          ///< of its file, without ".tsv"
    size_t part;                             ///< number of the pair type or group
    size_t first, count;                     ///< its values among those of the target; 0: none
    size_t places;                           ///< columns of where they are
    const char *place[2];                    ///< "r[lambda]"
    bool beside, values_beside;              ///< which of them have physical units beside
    const char *place_format, *value_format; ///< NULL: as usual
    const double *given;                     ///< values as the file has them; NULL: the same
};

/// The record of a reader of targets: how the object of a kind is read, kept, written back and
/// shown. One reader serves all kinds of the same form. A form of its own is a file with a record,
/// and that in the list of target_files.c. Tested: test_target_files.
struct target_record {
    const char *topic, *summary;   ///< of `mesofit describe`
    const char *chief;             ///< key that is proposed where a value is written for the object
    const struct field *fields[4]; ///< of its object, for `describe`; NULL-terminated
    enum observable_form form;     ///< of the kinds that it reads
    const char *kinds[8];          ///< which of these by their names; none: all that no other names
    size_t size;                   ///< of what it keeps of a kind, zeroed before

    /// Read the object of a target, whose struct target_use and settings are read before. Faults go
    /// to the document. Fails: NO_MEMORY.
    enum status (*read)(struct target_files *files, int kind, struct json_object *object,
                        const struct target_scene *scene);
    /// Let follow what does from parameters, and from a composition, that were chosen after it was
    /// read. Faults go to the document. Fails: NO_MEMORY. NULL: nothing does.
    enum status (*complete)(struct target_files *files, int kind, struct json_object *object,
                            const struct target_scene *scene);
    void (*clear)(void *own); ///< NULL: nothing is to be freed
    /// NULL: the first of `fields`, which are at the beginning of what it keeps.
    void (*write)(const struct target_files *files, int kind, struct json_writer *writer);
    /// Values and errors, as a fit takes them.
    struct target (*values)(const struct target_files *files, int kind);
    /// Table of part n, false beyond the last; and where its value number k is. NULL: none.
    bool (*table)(const struct target_files *files, int kind, size_t n, struct target_table *table);
    void (*place)(const struct target_files *files, int kind, const struct target_table *table,
                  size_t k, double at[2]);
};

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
