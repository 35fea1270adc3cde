// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A potential on the grid of another engine, and how far that engine's interpolation between
/// the rows is from the potential.
#pragma once

#include "export/export_model.h"

/// Φ and F = −dΦ/dr on rows from `first` to `last`.
struct export_grid {
    size_t rows;
    double first, last;      ///< [λ]
    double *r, *phi, *force; ///< shape [rows] [λ], [k_B T_0], [k_B T_0/λ]
    double *second;          ///< shape [rows]: of a spline, its second derivative; or NULL
};

/// How an engine places its rows and reads between them. `value` takes r from the first row to the
/// last. Each is written from the engine's source, which lab/export.md names.
struct export_interpolation {
    const char *summary;
    double first; ///< of the first row, as a share of the cutoff
    double (*place)(const struct export_grid *grid, size_t row); ///< r of a row
    enum status (*prepare)(struct export_grid *grid); ///< once all rows are there, or NULL
    void (*value)(const struct export_grid *grid, double r, double *phi, double *force);
};

/// Linear in r² of Φ and of F/r (LAMMPS, "table linear"). The first row's force makes F/r there
/// that of the second, so that it does not diverge between them.
/// Linear in r of Φ and F, with both ends among the rows (ESPResSo), or without the last (HOOMD).
/// The natural spline of Φ (OpenMM); Hermite's cubics of Φ and F (GROMACS); quadratics of Φ and of
/// r F each (DL_POLY).
extern const struct export_interpolation mf_export_grid_square, mf_export_grid_linear,
    mf_export_grid_open, mf_export_grid_spline, mf_export_grid_hermite, mf_export_grid_quadratic;

/// Largest errors, from the nearest distance that is accessible on: there Φ is at most
/// EXPORT_ACCESSIBLE k_B T above its minimum, and it is at least EXPORT_NEAREST of the cutoff.
struct export_error {
    double from;          ///< that distance [λ]
    double phi;           ///< of the energy [k_B T]
    double force;         ///< of the force, over the largest one there
    double largest_force; ///< [k_B T_0/λ]
};
#define EXPORT_ACCESSIBLE 20.0
#define EXPORT_NEAREST 0.02

/// What is asked of an interpolation: energy in k_B T and force over the largest.
#define EXPORT_PHI_BOUND 1e-4
#define EXPORT_FORCE_BOUND 1e-3

/// Place `rows` rows up to `last` and read the table of a pair type there. Fails: NO_MEMORY.
enum status mf_export_grid_make(struct export_grid *grid,
                                const struct export_interpolation *interpolation,
                                const struct table *table, int pair, double last,
                                size_t rows) MUST_USE;
void mf_export_grid_clear(struct export_grid *grid);

/// Compare what an engine reads with the potential, at 200,000 distances; after the last row only
/// Φ. Tested: test_export_model.
struct export_error mf_export_grid_error(const struct export_grid *grid,
                                         const struct export_interpolation *interpolation,
                                         const struct table *table, int pair, double temperature);

/// The potentials of a model for an engine: all with as many rows, enough for the bounds.
struct export_grids {
    int curves, pairs; ///< curves: 1, or EXPORT_CURVES with error bands
    struct export_grid grid[EXPORT_CURVES][COMPOSITION_MAX_PAIRS];
    struct export_error error; ///< the worst of all
};

/// @param[in] last  of all grids [λ]; 0: each ends at its own cutoff
/// Fails: NO_MEMORY; BAD_INPUT if even the longest table does not meet the bounds.
/// Tested: test_export_model, cli/test_export.
enum status mf_export_grids_make(struct export_grids *grids,
                                 const struct export_interpolation *interpolation,
                                 const struct export_model *model, bool bands,
                                 double last) MUST_USE;
void mf_export_grids_clear(struct export_grids *grids);
