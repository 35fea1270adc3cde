// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What `mesofit export --engine lammps` has written to the folder "lammps", run by Debian's
/// lmp, beside the result in "out" that it was written of.
#pragma once

#include "export/export_model.h"

/// Skip the test where there is no lmp, or where it lacks a style; NULL: none is asked for.
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

/// Root mean square of the difference of g in the last rows of lammps/rdf.dat from that of
/// out/rdf.tsv, of a hundred bins and one pair type.
/// @param[in] unit  of the engine's length
double lammps_runs_rdf_difference(double unit);

/// Mean of a column of lammps/thermo.dat, and its error by twenty blocks. Columns: the step,
/// temperature, pressure, energy of a particle.
double lammps_runs_mean(int column, double *error);
