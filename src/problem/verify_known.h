// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How well a verification knows what it is for.
#pragma once

#include "problem/measurement.h"

/// What replicas have measured together, how far that is from their targets, and the standard error
/// of each rms: by leaving out one replica in turn (jackknife), of g(r) by leaving out blocks, of
/// which there are more; NaN: not known. Fails: NO_MEMORY.
/// @param[in]  replicas         shape [count]; in the same order afterwards
/// @param[out] observed         zeroed before; to be cleared, also after a failure
/// @param[out] distance, error  shape [TARGETS]
enum status mf_verify_distances(struct measurement *replicas, size_t count,
                                struct observed *observed, struct target_distance *distance,
                                double *error) MUST_USE;

/// Whether the samples so far tell what a verification must: the rms difference from each target
/// that is a curve within a tenth of it, half of its square at most being their own noise; each
/// number as well as its target does; both temperatures within a third of a per cent; and nothing
/// drifts. Fails: NO_MEMORY. Tested: test_verify_known.
enum status mf_verify_knows(struct measurement *replicas, size_t count, bool *known) MUST_USE;
