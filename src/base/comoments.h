// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Covariance matrices, updated and merged without cancellation.
#pragma once

#include "base/memory.h"

#include <stddef.h>

/// Mean vector and co-moment matrix C = Σ (x − x̄)(x − x̄)ᵀ of `size` numbers.
/// Updated and merged as in T. F. Chan, G. H. Golub and R. J. LeVeque, The American
/// Statistician 37, 242 (1983), eqs. 1.3 and 2.1: no difference of large sums appears.
struct comoments {
    size_t size;
    double count;
    double *mean;     ///< shape [size]
    double *comoment; ///< shape [size, size], row-major, symmetric
    double *scratch;  ///< shape [size]
};

enum status mf_comoments_init(struct comoments *moments, size_t size) MUST_USE;
void mf_comoments_clear(struct comoments *moments);

/// All that it has seen; returns the number of spans, 3.
size_t mf_comoments_spans(struct comoments *moments, struct memory_span *spans);

/// Forget all samples.
void mf_comoments_reset(struct comoments *moments);

/// Add one sample x of shape [size].
void mf_comoments_add(struct comoments *moments, const double *x);

/// Add all samples of `other`. Merge in a fixed order for the same bits at any thread count.
void mf_comoments_merge(struct comoments *moments, const struct comoments *other);

/// Covariance ⟨x_a x_b⟩ − ⟨x_a⟩⟨x_b⟩ (population form) of one pair of components.
double mf_comoments_covariance(const struct comoments *moments, size_t a, size_t b);
