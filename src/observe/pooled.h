// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One value and error from the values and errors of replicas.
#pragma once

#include "observe/observable.h"

/// A replica's values of one target, and how many blocks of time its errors rest on.
struct pooled_curve {
    const double *value, *error; ///< shape [values.count]
    double blocks;
};

/// Add one replica's values to the means over `count` of them, and its errors as those of
/// independent values. Nothing if the target is not asked for.
void mf_pooled_add(const struct observable_values *values, const double *value, const double *error,
                   size_t count);

/// Means over the replicas, and their standard errors: the variance by blocks of time, of which
/// each replica has B, with count (B − 1) degrees of freedom, and that by the scatter of the
/// replicas, with count − 1, count as much as they know. A replica of one window alone has B = 1,
/// and no error of its own. Tested: test_pooled.
void mf_pooled_join(const struct observable_values *values, const struct pooled_curve *replicas,
                    size_t count);

/// What one replica says of a target, if it is asked for: its first numbers, shape [values.count].
void mf_pooled_set(const struct observable_values *values, const double *value,
                   const double *error);

/// All targets of an observable from `count` replicas. @param[in] values  shape [targets]
/// Fails: NO_MEMORY. Tested: test_structure_factor, test_diffusion.
enum status mf_pooled_result(const struct observable *observable, const void *const *states,
                             size_t count, const struct observable_values *values) MUST_USE;
