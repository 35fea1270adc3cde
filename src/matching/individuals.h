// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The individuals that an optimiser has asked for: what they were, their errors, whose
/// children they are.
#pragma once

#include "problem/parametrisation.h"

struct individuals {
    size_t variables, capacity;
    double *row;    ///< shape [capacity, INDIVIDUALS_HEAD + variables]: the last ones
    uint64_t count; ///< ever
};

/// Numbers of a row before its variables: iteration, error, two parents.
enum { INDIVIDUALS_HEAD = 4 };

/// Fails: NO_MEMORY.
enum status mf_individuals_init(struct individuals *individuals, size_t variables) MUST_USE;
void mf_individuals_clear(struct individuals *individuals);

/// Add the next one.
/// @param[in] parent  numbers of its parents, from 1; 0: none
void mf_individuals_add(struct individuals *individuals, uint32_t iteration,
                        const double *variables, double error, const uint64_t parent[2]);

/// Write individuals.tsv, a row each with the coefficients of its curves and its numbers, and for
/// each Bézier curve genes_potential.tsv and so on: r, where it lies among the control points (0:
/// at the first, 1: at the last), and what the curve is added to. Fails: IO, NO_MEMORY.
/// Tested: cli/test_fit.
enum status mf_individuals_write(const struct individuals *individuals,
                                 const struct parametrisation *parametrisation,
                                 const struct inverse_folder *folder) MUST_USE;

enum { INDIVIDUALS_SPANS = 2 };
size_t mf_individuals_spans(struct individuals *individuals, struct memory_span *spans);
