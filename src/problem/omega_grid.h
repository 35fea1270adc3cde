// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The points at which a fitted friction weight ω(r) is known: equally spaced from the inner
/// cutoff, below which ω is 0, to the cutoff, where it ends at 0.
#pragma once

#include "curves/table.h"

#include <stddef.h>

enum { OMEGA_POINTS = 201 };

struct omega_grid {
    double inner_cutoff, cutoff; ///< [λ]
    double r[OMEGA_POINTS];      ///< [λ]
};

void mf_omega_grid_init(struct omega_grid *grid, double inner_cutoff, double cutoff);

/// Straight pieces between the points; 0 below the first.
/// @param[in] omega  shape [OMEGA_POINTS], ≥ 0 [sqrt(mass/time)]
double mf_omega_grid_value(const struct omega_grid *grid, const double *omega, double r);

/// Table for the kernels. Fails: NO_MEMORY.
enum status mf_omega_grid_table(const struct omega_grid *grid, const double *omega,
                                struct table *table) MUST_USE;
