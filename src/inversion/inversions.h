// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The inversions of g(r): methods of fits by name.
#pragma once

#include "problem/inverse.h"

#define INVERSIONS(EACH)                                                                           \
    EACH(automatic)                                                                                \
    EACH(imc)                                                                                      \
    EACH(ibi)                                                                                      \
    EACH(hnc)                                                                                      \
    EACH(relative_entropy)                                                                         \
    EACH(force_matching)

#define INVERSION_DECLARE(name) extern const struct inverse_method mf_##name;
INVERSIONS(INVERSION_DECLARE)
#undef INVERSION_DECLARE
