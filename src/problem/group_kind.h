// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the groups of a fit are whose energy is found from how a number is distributed: terms
/// of molecules, of an order each (curves/bonded_kind.h), or local densities ρ_i of beads
/// (forces/many_body.h), of the order INVERSE_LOCAL_DENSITY.
#pragma once

#include "observe/weighted_density.h"
#include "problem/inverse.h"

/// The target that an order is found from, among all kinds.
int mf_group_kind_target(int order);

/// Whether the first value follows the last, as of dihedrals; and whether it is a length.
bool mf_group_kind_is_periodic(int order);
bool mf_group_kind_is_length(int order);

/// Whether there can be such a value [λ], [degrees] or [1].
bool mf_group_kind_is_possible(int order, double value);

/// ∫ of the Jacobian over a bin: mf_bonded_distribution_jacobian, 1 of densities.
double mf_group_kind_jacobian(int order, int dimensions, const struct bonded_bins *bins,
                              size_t bin);

/// Terms of molecules, or beads with such an energy, in a system of so many beads.
size_t mf_group_kind_terms(const struct topology *topology, const struct bonded_unknown *unknown,
                           size_t beads);

/// The weight of the target of local densities, and its bins.
const struct weighted_density_settings *mf_group_kind_density(const struct targets *targets);

/// "bond", "local density"; what a file's name begins with, "bonds", "many_body"; and what the
/// scene calls the group.
const char *mf_group_kind_name(int order);
const char *mf_group_kind_file(int order);
const char *mf_group_kind_group(const struct simulation_setup *scene,
                                const struct bonded_unknown *unknown);
