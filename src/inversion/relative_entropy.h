// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The parameters of the method "relative-entropy".
#pragma once

#include "inversion/inversion_state.h"

struct relative_entropy_parameters {
    struct inversion_parameters common;
    struct inversion_basis_size size;
};
