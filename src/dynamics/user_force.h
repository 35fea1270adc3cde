// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Forces of whoever uses the library, as an interaction.
#pragma once

#include "forces/interaction.h"

#include <stddef.h>
#include <stdint.h>

/// Adds to `force`, shape [dimensions][count] in the order of `id`, and returns the energy.
typedef double user_force_function(void *context, size_t count, const uint32_t *id,
                                   const double *const *position, double *const *force);

struct user_force {
    user_force_function *function;
    void *context;
};

/// Parameters: struct user_force, which may change meanwhile; a function NULL does nothing. Its
/// energy counts, its virial does not: forces from outside are no part of the pressure.
extern const struct interaction mf_user_force;
