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

extern const char *const mf_density_profile_axes[];
extern const struct observable mf_density_profile_observable;
