// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A g(r) that is known at any r, as a figure that was digitised, read at equally spaced r.
#pragma once

#include "targets/target_rows.h"

/// What was done; `points` 0: nothing, for the rows are equally spaced.
struct target_resampling {
    size_t points;            ///< of the file
    double shortest, longest; ///< steps between them [λ]
    double error;             ///< of a point, by their scatter or assumed; 0: the file has errors
    double error_in_r;        ///< of a point, in r [λ]
    bool assumed;             ///< no scatter tells it
    double interpolation;     ///< the largest error that is added where points are far apart
    double interpolation_at;  ///< [λ]
};

/// Whether steps differ from their mean by more than the rounding of a file, 1 %.
bool mf_target_resample_is_needed(const struct target_rows *rows);

/// Replace the rows by as many equally spaced ones.
///
/// g between points is that of the cubic through four of them, which is what the scatter of the
/// points is told by, by the quintic through six neighbours. Without errors of
/// the file all points have the same one of g and of r, as those that are read from a figure, or
/// `assumed` of g if there is none. What lies between points is no new information: where rows are
/// closer together than points are, their errors are larger by the root of that ratio. Added to it
/// is the error of the interpolation, by the next order. Core rows, where g is 0, keep the error 0.
/// Needs at least 5 rows. Fails: BAD_INPUT where points are so far apart that their g could be
/// anything; NO_MEMORY. Tested: test_target_resample.
enum status mf_target_resample(struct target_rows *rows, const char *file, bool has_errors,
                               double assumed, struct target_resampling *done) MUST_USE;
