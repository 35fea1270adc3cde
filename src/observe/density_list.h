// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The weighted density around each particle of a configuration, by a list of its own that is
/// as long as the weight is.
#pragma once

#include "observe/weighted_density.h"
#include "system/neighbours.h"

struct density_list {
    struct weighted_density_settings settings;
    struct particles particles; ///< a sorted copy
    struct neighbours neighbours;
    double *values;   ///< shape [count]: ρ_i = Σ_j w(r_ij), by id
    double *stresses; ///< shape [count]: Σ_j r w'(r_ij), by id
};

/// Must be cleared, also after a failure. Fails: BAD_INPUT if the weight is too long for the box;
/// NO_MEMORY.
enum status mf_density_list_init(struct density_list *list,
                                 const struct weighted_density_settings *settings,
                                 const struct box *box, size_t count) MUST_USE;
void mf_density_list_clear(struct density_list *list);

/// Fill in what a configuration has. Fails: NO_MEMORY. Tested: test_weighted_density (unit, cli).
enum status mf_density_list_find(struct density_list *list, const struct particles *from) MUST_USE;
