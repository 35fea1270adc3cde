// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Density along an axis of the box, of each type: slabs, walls, interfaces.
///
/// Errors are of blocks in time (sample_blocks), which see correlation as those of g(r) do. A bin
/// in which nothing was ever has no scatter; its error is the density that one visit would have
/// made,
///   F c,   F = Σ error²/(c Σ ρ) over the bins of the curve, at least 1,
/// with the density c that one bead in one sample makes of all samples. A visit lasts: F is how
/// many samples see it, since error² = F c ρ where visits are rare and independent of each other.
#pragma once

#include "observe/observable.h"
#include "observe/sample_blocks.h"
#include "system/composition.h"

struct density_profile_settings {
    int axis;
    int64_t bins;
};

struct density_profile_plan {
    struct composition composition;
    size_t bins, samples; ///< samples 0: as many as there will be
    int axis;
    bool masses; ///< beads have masses, in u, and volumes are in nm³
};

/// All zero is none.
struct density_profile {
    struct density_profile_plan plan;
    size_t row; ///< numbers of a sample: of types and, behind them, their masses, times bins
    struct sample_blocks blocks;
    double *sums;  ///< shape [blocks, row]: densities, over the samples of a block
    double *block; ///< of the sample that is being taken
};

/// Fails: NO_MEMORY.
enum status mf_density_profile_init(struct density_profile *profile,
                                    const struct density_profile_plan *plan) MUST_USE;
void mf_density_profile_clear(struct density_profile *profile);

/// Begin the next sample.
void mf_density_profile_next(struct density_profile *profile);

/// Add a bead of it. @param[in] share   of the way along the box, from 0 to 1
/// @param[in] density  one over the volume of a bin
/// Tested: cli/test_density_profile, test_measured.
static inline void density_profile_add(struct density_profile *profile, int type, double share,
                                       double density, double mass) {
    const size_t bins = profile->plan.bins, bin = (size_t)(share * (double)bins);
    const size_t at = (size_t)type * bins + (bin < bins ? bin : bins - 1);
    profile->block[at] += density;
    if (profile->plan.masses)
        profile->block[(size_t)profile->plan.composition.types * bins + at] += density * mass;
}

/// Write density_profile.tsv: the middle of a bin; density and error of each type; with masses the
/// same in g/cm³, and of all types together. Fails: IO, NO_MEMORY.
/// @param[in] length  of the box along the axis
enum status mf_density_profile_write(const struct density_profile *profile, double length,
                                     int dimensions,
                                     const struct observable_results *results) MUST_USE;

size_t mf_density_profile_spans(struct density_profile *profile, struct memory_span *spans);

extern const char *const mf_density_profile_axes[];
extern const struct observable mf_density_profile_observable;
