// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What each iteration of an inversion has seen: S − S*.
#pragma once

#include "base/memory.h"
#include "base/status.h"

#include <stdint.h>

struct inversion_history {
    size_t capacity, bins;
    uint64_t iterations;
    double *excess; ///< ⟨S⟩ − S*, shape [capacity, bins]
};

/// Room for `capacity` iterations. Must be cleared, also after a failure. Fails: NO_MEMORY.
enum status mf_inversion_history_init(struct inversion_history *history, size_t capacity,
                                      size_t bins) MUST_USE;
void mf_inversion_history_clear(struct inversion_history *history);

/// Add an iteration: ⟨S⟩ of its samples and S*, of shape [bins] as the unit of S, which is infinite
/// in bins without a target.
void mf_inversion_history_add(struct inversion_history *history, const double *counts,
                              const double *target_counts, const double *unit);

/// What a checkpoint keeps; returns the number of spans.
size_t mf_inversion_history_spans(struct inversion_history *history, struct memory_span *span);
