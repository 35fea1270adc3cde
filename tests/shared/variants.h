// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The kernels that this processor can run: every instruction set in every precision. What
/// holds for one of them must hold for all.
#pragma once

#include "forces/pair.h"

struct variant {
    const char *instruction_set;
    enum pair_precision precision;
    char name[32]; ///< "avx2, mixed"
};

enum { VARIANTS_MAX = 6 };

/// Fill `variants` with those of this processor, and return their number. The first is what a
/// simulation uses that asks for nothing: the best instruction set in mixed precision.
int variants_find(struct variant variants[VARIANTS_MAX]);

/// Use the instruction set of a variant from now on; the precision is for a law or a setup.
void variants_select(const struct variant *variant);
