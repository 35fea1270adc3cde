// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Slow twins of the configurational temperature and of local densities, in double precision.
#pragma once

#include "forces/many_body.h"

/// As mf_configurational, one pair after the other.
enum status slow_forces_configurational(const struct table *potential,
                                        const struct composition *composition, double temperature,
                                        const struct particles *particles,
                                        const struct neighbours *neighbours, double *const *known,
                                        double *const *others, double *squares,
                                        double *laplacian) MUST_USE;

/// Energies, forces and virials of local densities by two loops over all pairs, in double
/// precision: what the vector kernels must find.
/// @param[out] force  shape [dimensions][count], to be added to [k_B T_0/λ]
/// @param[out] sums   to be added to
/// Fails: NO_MEMORY.
enum status slow_forces_many_body(const struct many_body *many_body,
                                  const struct particles *particles, double *const *force,
                                  struct pair_sums *sums) MUST_USE;
