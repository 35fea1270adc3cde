// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a scene gives to each particle: a mass, a radius, a stiffness.
///
/// The particles have an attribute of that name (mf_particles_numbers) if the scene has it,
/// and nothing otherwise.
#pragma once

#include "base/fields.h"
#include "system/composition.h"
#include "system/particles.h"

#include <math.h>

enum attributes_name {
    ATTRIBUTES_MASS,
    ATTRIBUTES_RADIUS,
    ATTRIBUTES_STIFFNESS,
    ATTRIBUTES_ORIENTATION,
    ATTRIBUTES_NAMES
};

struct attributes_range {
    double minimum, maximum;
};

/// Where the numbers of an attribute come from. Plain data; all zero: the scene has none.
struct attributes_source {
    int ranges; ///< 0: none; 1: one range for all; else one for each type
    /// Numbers are uniform in it. Of a column: what the column spans.
    struct attributes_range range[COMPOSITION_MAX_TYPES];
    const double *column; ///< of a file, shape [count] by particle id, or NULL; borrowed
};

/// Name, unit, allowed range and meaning of each, in the order of enum attributes_name.
extern const struct field mf_attributes_fields[];

/// Smallest and largest number that an attribute can have, over all types.
struct attributes_range mf_attributes_span(const struct attributes_source *source);

/// Expected sum of an attribute over all particles, each of which has the `usual` number if the
/// scene has none. Tested: test_attributes.
double mf_attributes_sum(const struct attributes_source *source, double usual,
                         const struct composition *composition, int64_t particles);

/// Whether all numbers of an attribute are `value`, but for rounding, or the scene has none.
static inline bool attributes_are(const struct attributes_source *source, double value) {
    const double rounding = 1e-12 * fabs(value);
    const struct attributes_range span = mf_attributes_span(source);
    return source->ranges == 0 ||
           (fabs(span.minimum - value) <= rounding && fabs(span.maximum - value) <= rounding);
}

/// Give the particles all attributes that have a source: numbers that depend on seed and id alone.
/// Fails: NO_MEMORY; BAD_INPUT as mf_particles_add_attribute. Tested: test_masses.
enum status mf_attributes_give(struct particles *particles,
                               const struct attributes_source source[ATTRIBUTES_NAMES],
                               const struct composition *composition, uint64_t seed) MUST_USE;
