// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What each iteration of an inversion has seen: S − S*, and the singular values of its step.
#pragma once

#include "base/memory.h"
#include "base/status.h"
#include "inversion/imc_solve.h"

#include <stdint.h>

struct inversion_trail {
    size_t capacity, bins;
    size_t singular_values; ///< of a step; 0: the method has none
    uint64_t iterations;
    double *excess;   ///< ⟨S⟩ − S*, shape [capacity, bins]
    double *singular; ///< falling, shape [capacity, singular_values]
    double *used;     ///< part of each that the last step has taken, shape [singular_values]
};

/// Room for `capacity` iterations. Must be cleared, also after a failure. Fails: NO_MEMORY.
enum status mf_inversion_trail_init(struct inversion_trail *trail, size_t capacity, size_t bins,
                                    size_t singular_values) MUST_USE;
void mf_inversion_trail_clear(struct inversion_trail *trail);

/// Tell the equations of the present iteration where to put their singular values.
void mf_inversion_trail_take(const struct inversion_trail *trail, struct imc_system *system);

/// End the present iteration, which has counted S: both of shape [bins].
void mf_inversion_trail_add(struct inversion_trail *trail, const double *counts,
                            const double *target_counts);

/// What a checkpoint keeps; returns the number of spans.
size_t mf_inversion_trail_spans(struct inversion_trail *trail, struct memory_span *span);
