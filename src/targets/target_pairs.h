// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A measured g(r), or in a mixture those of all pair types, {"A-A": {"file": …}, …}: of all
/// pairs, or of beads of different molecules.
#pragma once

#include "targets/target_rdf.h"
#include "system/composition.h"

/// Tested: test_target_files, test_target_files_mixture.
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
