// SPDX-License-Identifier: GPL-3.0-or-later
/// @file g(r) as simulations measure it: counted, from forces, or both.
#pragma once

#include "observe/observable.h"
#include "observe/rdf_force.h"

struct rdf_settings {
    double range;   ///< 0: the cutoff of the forces [λ]
    int64_t bins;   ///< from 0 to the range
    int estimator;  ///< enum rdf_force_estimator; with forces the pairs are counted as well
    bool of_target; ///< bins are those of a target, and pairs are counted only where forces tell
                    ///< nothing: in mixtures and without a barrier (mf_rdf_force_applies)
    struct rdf_bins target;
};

/// What is not planned is not measured.
struct rdf_observed {
    struct rdf counted;
    struct rdf_force force;
    double time; ///< from the first sample to the last [τ]
};

/// Of beads of different molecules, and of single ones.
extern const struct observable mf_rdf_intermolecular;

/// Its target's number (mf_observable_kind): values of the shape [pairs, bins], as those of g(r) of
/// all pairs.
int mf_rdf_intermolecular_kind(void);

/// Whether g(r) is measured and its errors are of samples (observe/sample_blocks.h): what has few
/// counts shows less of what is slow. Fails: NO_MEMORY. Tested: test_simulate_pairs.
enum status mf_rdf_observable_is_of_samples(const struct observable_results *results,
                                            bool *of_samples) MUST_USE;

/// Path of the table of a pair type, rdf.tsv or in a mixture rdf_A-B.tsv, into OUTPUT_PATH_SIZE
/// bytes.
/// @param[in] name  "rdf" or "intermolecular_rdf"
void mf_rdf_observable_file(const char *folder, const char *name,
                            const struct composition *composition, int pair, char *path);
