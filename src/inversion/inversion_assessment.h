// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How far samples are from their targets: those of one state, or of all together.
#pragma once

#include "inversion/inversion_equilibrium.h"
#include "problem/inverse.h"

/// Consecutive bins of one kind of targets: those of all pairs, those of all bonds, …
struct inversion_section {
    int kind;                  ///< enum target_kind, or of mf_bonded_distribution_kind
    size_t bin, bins;          ///< the first one among all, and how many there are
    size_t known, known_count; ///< the same of those that are known
    double peak;               ///< largest value of a group's target; of g 1
    double inefficiency;       ///< samples that count as one independent
    double rms, noise;         ///< of what the factors of targets do not explain, in peaks
    double own_noise;  ///< of the samples alone, of which a bin whose target is noisier than
                       ///< others bears as much more
    double misfit;     ///< χ² by bin of the samples, with the noise that they expect
    double own_misfit; ///< what the noise of the samples alone adds to it
    double probable;   ///< the same at most, of what agrees but for noise
    double precision;  ///< at which that is small enough
};

enum { INVERSION_MAX_SECTIONS = 1 + INVERSE_MAX_BONDED };

/// Whether the samples meet its targets but for noise.
static inline bool inversion_section_agrees(const struct inversion_section *section) {
    return section->misfit <= section->probable;
}

struct inversion_assessment {
    struct inversion_section section[INVERSION_MAX_SECTIONS];
    int sections;
    struct target_distance distance[TARGETS]; ///< from what is asked for
    double bulk_reach;   ///< how near to it a step may be asked to come, and is judged by:
                         ///< mf_inversion_bulk_measure
    double own_noise;    ///< by the samples alone, rms, of the noisiest section
    double misfit;       ///< χ² of the excess by bin
    double disagreement; ///< of the replicas, mf_replicas_disagreement
    struct inversion_unequilibrated unequilibrated; ///< `found`: the samples are not those of
                                                    ///< equilibrium, and there are to be no more
    bool unstable;   ///< there are none: another engine could not sample the potential, and all
                     ///< numbers are those of the one before
    bool useless;    ///< what has not settled of them might change a step
    int64_t stretch; ///< of their equilibration and spacing
};

/// The section that is farthest off, by its χ².
const struct inversion_section *
mf_inversion_assessment_worst(const struct inversion_assessment *assessment);

/// Whether the samples are as exact as was asked for.
bool mf_inversion_assessment_is_precise(const struct inversion_assessment *assessment);

/// Distances from all targets together, each in units of the noise of these samples, that from the
/// pressure, or the density, of what it can be asked for.
double mf_inversion_assessment_noises(const struct inversion_assessment *assessment,
                                      const struct targets *targets,
                                      const struct target_distance distance[TARGETS]);

/// Whether each section is so near to its targets, by their noise, that C hardly changes any more.
/// @param[in] stays  the samples before were near: they may be a little farther off
bool mf_inversion_assessment_is_near(const struct inversion_assessment *assessment, bool stays);
