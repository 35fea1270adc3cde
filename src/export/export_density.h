// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Energies of local densities as LAMMPS's pair_style eam/fs reads them: tables of w and of f
/// on rows that are equally far apart in r and in ρ.
///
/// The embedded-atom method is of this form, with a weight of any shape for each pair of types;
/// LAMMPS's own local/density has one weight alone. LAMMPS lays cubics through the rows, whose
/// slopes it takes of four rows about each, and continues f with the slope of the last row.
#pragma once

#include "export/export_grid.h"
#include "export/export_units.h"

#include <stdio.h>

/// A term. The grids' `r` is ρ or r, `phi` is f [k_B T_0] or w, `force` the slope by −1.
struct export_density {
    struct export_grid energy, weight;
    double high; ///< the last ρ of f
};

/// All zero: none.
struct export_densities {
    int terms;
    struct export_density table[MANY_BODY_MAX_TERMS];
    /// The worst of what LAMMPS reads of f between 0 and `high`: [k_B T], and of the slope over the
    /// largest one at densities that the configuration has.
    struct export_error error;
};

/// f is written to this many times the largest density of the configuration, and at least to that
/// of this number of neighbours spread within the cutoff.
#define EXPORT_DENSITY_ROOM 4.0
#define EXPORT_DENSITY_LEAST 64.0

/// Slopes of f and w may be wrong by this share of the largest, those of f from this share of the
/// last ρ on: at ρ = 0 LAMMPS takes the slope of two rows.
#define EXPORT_SLOPE_BOUND 1e-4
#define EXPORT_DENSITY_FIRST 0.002

/// Make the tables of a model, each of so many rows that it is right within EXPORT_PHI_BOUND and
/// EXPORT_SLOPE_BOUND. A model without "many_body" has none.
/// Fails: NO_MEMORY; BAD_INPUT for a weight that is below 0 somewhere, or if even the longest table
/// does not meet the bounds. Tested: cli/test_export_many_body,
/// physics/test_export_lammps_many_body.
enum status mf_export_densities_make(struct export_densities *densities,
                                     const struct export_model *model) MUST_USE;
void mf_export_densities_clear(struct export_densities *densities);

/// What to multiply ρ of a term by: those of weights with the integral 1 are densities.
/// @param[in] length  unit of the engine
double mf_export_density_unit(const struct export_model *model, int term, double length);

/// Lines of the block: up to what density each f is tabulated. Nothing of a model without them.
void mf_export_densities_print(const struct export_densities *densities,
                               const struct export_model *model, const struct export_units *units,
                               const char *prefix, FILE *stream);

/// The terms of a model; NULL: it has none.
const struct many_body *mf_export_densities_of(const struct export_model *model);

/// Read the energies that a fit found: many_body_NAME.tsv of its folder. Fails: BAD_INPUT, naming
/// the file; IO; NO_MEMORY. Tested: cli/test_fit_densities.
enum status mf_export_densities_read(struct export_model *model) MUST_USE;
