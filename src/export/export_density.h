// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Energies of local densities as LAMMPS's pair_style local/density reads them: f on rows
/// that are equally far apart in ρ.
///
/// LAMMPS lays the cubic spline through the rows whose slopes at both ends are 0, and takes them to
/// be 0 beyond. So the rows begin below 0 and end beyond the largest density by enough of them that
/// nothing of this is left between.
#pragma once

#include "export/export_grid.h"

#include <stdio.h>

/// f of a term; `phi` has f [k_B T_0], `r` has ρ.
struct export_density {
    struct export_grid grid;
    double high; ///< f is right from ρ = 0 to here
};

/// All zero: none.
struct export_densities {
    int terms;
    struct export_density table[MANY_BODY_MAX_TERMS];
    /// The worst of what LAMMPS reads between 0 and `high`: [k_B T], and of the slope over the
    /// largest one at densities that the configuration has.
    struct export_error error;
};

/// f is written to this many times the largest density of the configuration, and at least to this
/// number of neighbours.
#define EXPORT_DENSITY_ROOM 4.0
#define EXPORT_DENSITY_LEAST 64.0

/// Make the tables of a model, each of so many rows that it is right within EXPORT_PHI_BOUND and
/// EXPORT_FORCE_BOUND. A model without "many_body" has none.
/// Fails: NO_MEMORY; BAD_INPUT for a weight that is not Sanyal and Shell's, which LAMMPS has alone,
/// or if even the longest table does not meet the bounds. Tested: cli/test_export_many_body,
/// physics/test_export_lammps_many_body.
enum status mf_export_densities_make(struct export_densities *densities,
                                     const struct export_model *model) MUST_USE;
void mf_export_densities_clear(struct export_densities *densities);

/// Lines of the block: up to what density each f is right. Nothing of a model without them.
void mf_export_densities_print(const struct export_densities *densities,
                               const struct export_model *model, const char *prefix, FILE *stream);

/// The terms of a model; NULL: it has none.
const struct many_body *mf_export_densities_of(const struct export_model *model);

/// Read the energies that a fit found: many_body_NAME.tsv of its folder. Fails: BAD_INPUT, naming
/// the file; IO; NO_MEMORY. Tested: cli/test_fit_densities.
enum status mf_export_densities_read(struct export_model *model) MUST_USE;
