// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A measured RDF to be matched.
#pragma once

#include "io/json.h"
#include "observe/finite_size.h"
#include "targets/target_resample.h"
#include "io/units.h"

/// "rdf" among the targets of a run file.
struct target_rdf_parameters {
    char file[FIELD_TEXT_SIZE];
    int format;                               ///< TARGET_ROWS_…
    double cutoff;                            ///< bins beyond are left out; 0: none [λ]
    int64_t r_column, g_column, error_column; ///< from 1; error_column 0: none, −1: 3 or none
    double bin_width;  ///< of bins that rows are joined to; 0: by itself [λ]
    int64_t particles; ///< of all types where it was measured; 0: as many as the scene has
    double normalisation, normalisation_error; ///< of g; 0: found, with this width about 1
    int errors_of;                             ///< enum target_errors
};

extern const struct field mf_target_rdf_fields[];

struct target_rdf {
    struct target_rdf_parameters parameters;
    uint64_t given;          ///< which of them the file says (mf_fields_bit)
    struct target_rows rows; ///< of the file, all of them
    struct rdf_bins bins;
    double *g, *error;       ///< shape [bins.count]
    size_t joined;           ///< rows of the file that make a bin
    double estimated_error;  ///< of g = 1 in the last bin if the file has no errors, else 0
    bool assumed;            ///< and not even the scatter of the rows tells it
    struct target_tail tail; ///< of the whole file, whatever the cutoff
    /// The rows of the whole file, if it goes on beyond the cutoff and has errors; else of none.
    /// Where its last twentieth is above 1, as by a faulty normalisation, over the mean of that.
    struct target_rdf_whole {
        struct rdf_bins bins;
        double *g, *error;
    } whole;
    struct target_resampling resampling;
    size_t negative; ///< rows with a g slightly below 0, which is taken as 0
    double min;      ///< of these [1]
};

/// Read the members of {"file": …}. Faults (gaps, negative values, …) go to the document and leave
/// the target empty. Rows that are not equally spaced are read at r that are, and g slightly below
/// 0 is 0. `units` convert VOTCA's nm; `dimensions` are those of space. Errors that the
/// file does not give are estimated from the scatter of its rows, which are then joined to bins.
/// Fails: NO_MEMORY. Tested: test_target_rdf.
enum status mf_target_rdf_read(struct target_rdf *target, struct json_object *object,
                               const struct units *units, int dimensions) MUST_USE;

/// Cut and join the rows again, once `cutoff` and `bin_width` have changed. Fails: BAD_INPUT,
/// NO_MEMORY.
enum status mf_target_rdf_cut(struct target_rdf *target) MUST_USE;

/// g and its errors in the numbers of the scene, by mf_finite_size_factor_of. VOTCA's g of like
/// pairs is normalised by N_a², and needs 1/(1 − 1/N_a) with the N_a that was measured.
/// @param[in]  fluid     the scene
/// @param[in]  pair      the pair type of this target
/// @param[out] g, error  shape [bins.count]
/// Tested: test_target_rdf, test_target_files_mixture.
void mf_target_rdf_convert(const struct target_rdf *target, const struct finite_size_fluid *fluid,
                           int pair, double *g, double *error);

void mf_target_rdf_clear(struct target_rdf *target);
