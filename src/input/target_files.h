// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "target" of a run file: the measured observables that a fit is to reproduce.
#pragma once

#include "problem/targets.h"
#include "inversion/normalisation.h"
#include "io/json_write.h"
#include "input/target_rdf.h"
#include "input/target_etd.h"

/// A measured function of time: VACF or MSD.
struct target_curve {
    struct target_curve_parameters {
        char file[FIELD_TEXT_SIZE];
        int64_t time_column, value_column,
            error_column; ///< from 1; error_column 0: none, −1: 3 or none
    } parameters;
    size_t times;          ///< 0: not given
    double interval;       ///< [τ]
    double *value, *error; ///< shape [times]
};

/// A measured number: the pressure, or D.
struct target_number {
    double value, error;
    double window; ///< of D: the slope of the MSD over its second half; 0: of other targets [τ]
};

extern const struct field mf_target_files_curve_fields[], mf_target_files_number_fields[];
extern const struct field mf_target_files_diffusion_fields[], mf_target_files_use_fields[];

struct target_files {
    bool given[TARGETS];
    struct target_rdf rdf[COMPOSITION_MOST_PAIRS]; ///< of each pair type
    struct composition composition;                ///< of the scene
    size_t pairs;                                  ///< its pair types
    /// Of all, one behind the other, in the numbers of the scene: shape [pairs, bins].
    double *rdf_g, *rdf_error;
    double *rdf_given;                  ///< g before it was divided by its normalisation
    struct normalisation normalisation; ///< by which those that do not say theirs are divided
    struct target_etd etd;
    struct target_curve vacf, msd;
    struct target_number diffusion, pressure;
    struct target_use {
        double weight; ///< 0: by the errors
        int fitted;    ///< 0: only compared with the result
    } use[TARGETS];
};

/// Read the object "target" of a scene of this box and composition; `units` convert VOTCA's tables.
/// Faults go to the document. Fails: NO_MEMORY.
enum status mf_target_files_read(struct target_files *files, struct json_object *root,
                                 const struct box *box, const struct composition *composition,
                                 const struct units *units) MUST_USE;
void mf_target_files_clear(struct target_files *files);
void mf_target_files_write(const struct target_files *files, struct json_writer *writer);

/// Add what was read from files to the digest of a checkpoint.
void mf_target_files_digest(const struct target_files *files, uint64_t *digest);

/// Divide g(r) by its normalisation: what the file says, else what mf_normalisation_find makes of
/// the target in this box. If the file says some of a mixture's, the others are 1. Fails:
/// NO_MEMORY.
enum status mf_target_files_normalise(struct target_files *files, const struct box *box) MUST_USE;

/// The targets of the scene: those to be fitted, and all. With `moves`, D is among
/// those to be compared even if no value is given, so that a result knows its own, if another
/// target says in what window.
void mf_target_files_targets(struct target_files *files, bool moves, struct targets *fitted,
                             struct targets *compared);

/// BAD_INPUT with the time steps that would do if an interval is not a whole number of steps.
enum status mf_target_files_check_steps(const struct target_files *files,
                                        double time_step) MUST_USE;
