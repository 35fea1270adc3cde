// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What `mesofit export --engine lammps` has written to the folder "lammps", run by Debian's
/// lmp, beside the result in "out" that it was written of.
#pragma once

#include "export/export_model.h"

/// Skip the test where LAMMPS is not to run (shared/other_engine.h), or lacks a style; NULL: none
/// is asked for.
void lammps_runs_skip_without(const char *style);

/// The exported configuration as our engine has it, with forces, energy and virial.
struct lammps_runs_ours {
    struct export_model model;
    struct simulation simulation;
};
void lammps_runs_find_ours(struct lammps_runs_ours *ours);
void lammps_runs_clear_ours(struct lammps_runs_ours *ours);

/// Energy of all terms of an order, as our engine has them.
double lammps_runs_energy_of(const struct lammps_runs_ours *ours, int order);

/// Forces and sums of the start, without the bath whose noise is a force, too.
/// @param[in]  columns  of thermo_style, without "step"
/// @param[out] values   shape [count], one for each of them
void lammps_runs_once(const char *columns, double *values, size_t count);

/// The largest difference of a force of lammps_runs_once from ours, in reduced units.
/// @param[in] unit  of the engine's force
double lammps_runs_compare_forces(const struct lammps_runs_ours *ours, double unit);

/// Move each coordinate of the exported configuration by up to 0.05 λ; one after the other from 0
/// on.
void lammps_runs_move(struct lammps_runs_ours *ours, uint32_t configuration);

/// The largest differences of LAMMPS from us in any of the configurations: the exported one, and
/// those that lammps_runs_move makes of it.
struct lammps_runs_apart {
    double energy;               ///< of a bead [k_B T_0]
    double force, largest_force; ///< and the largest force [k_B T_0/λ]
};
struct lammps_runs_apart lammps_runs_compare(int configurations);

/// Root mean square of the difference of g in the last rows of lammps/rdf.dat from that of
/// a table of the result, of a hundred bins, by the volumes of the bins.
/// @param[in] unit  of the engine's length
/// @param[in] pair  whose columns are compared, from 0 on
double lammps_runs_rdf_difference_of(const char *table, int pair, double unit);
/// The same of out/rdf.tsv and one pair type.
double lammps_runs_rdf_difference(double unit);

/// Mean of a column of lammps/thermo.dat, and its error by twenty blocks. Columns: the step,
/// temperature, pressure, energy of a particle, density.
double lammps_runs_mean(int column, double *error);
