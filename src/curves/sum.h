// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A sum of potentials: the law "sum".
#pragma once

#include "curves/table.h"

/// Φ = Σ Φ_k, each up to its own cutoff and shifted to 0 there, as it would be alone.
extern const struct curve_family mf_sum_family;

enum { SUM_MAX_PARTS = 8, SUM_NAME_SIZE = 32 };

/// Owns its curves.
struct sum_parameters {
    int parts;
    char name[SUM_MAX_PARTS][SUM_NAME_SIZE]; ///< as the scene calls them
    struct curve part[SUM_MAX_PARTS];        ///< each once it was checked (mf_curve_check)
};

/// Value of a curve as its table has it, less what it has at its cutoff. Tested: test_sum.
double mf_sum_shifted(const struct curve *curve, double r);

/// Table of the sum of two curves that were checked. Fails: as mf_table_init_potential.
enum status mf_sum_tabulate(struct table *table, const struct curve *one,
                            const struct curve *other) MUST_USE;
