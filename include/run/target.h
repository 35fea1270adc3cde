// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A measured RDF to be matched.
#pragma once

#include "io/json.h"
#include "observe/rdf.h"
#include "run/units.h"

/// Of the file: columns in units of the scene, or a .dist.tgt of VOTCA.
enum { TARGET_COLUMNS, TARGET_VOTCA };

/// "rdf" among the targets of a run file.
struct target_parameters {
    char file[FIELD_TEXT_SIZE];
    int format;                               ///< TARGET_…
    double cutoff;                            ///< bins beyond are left out; 0: none [λ]
    int64_t r_column, g_column, error_column; ///< from 1; error_column 0: no errors given
    int64_t particles; ///< of all types where it was measured; 0: as many as the scene has
    double normalisation, normalisation_error; ///< of g; 0: found, with this width about 1
};

extern const struct field target_fields[];

struct target {
    struct target_parameters parameters;
    struct rdf_bins bins;
    double *g, *error; ///< shape [bins.count]
};

/// Read the members of {"file": …}. Faults (gaps, negative values, …) go to the document and leave
/// the target empty. `units` convert VOTCA's nm. Fails: NO_MEMORY. Tested: test_target.
enum status target_read(struct target *target, struct json_object *object,
                        const struct units *units) MUST_USE;

/// g and its errors in the numbers of the scene, by finite_size_factor_of. VOTCA's g of like pairs
/// is normalised by N_a², and needs 1/(1 − 1/N_a) with the N_a that was measured.
/// @param[in]  box, composition  of the scene
/// @param[in]  pair              the kind of pairs of this target
/// @param[out] g, error          shape [bins.count]
/// Tested: test_target, test_targets_mixture.
void target_convert(const struct target *target, const struct box *box,
                    const struct composition *composition, int pair, double *g, double *error);

void target_clear(struct target *target);
