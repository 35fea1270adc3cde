// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Molecules and energies of local densities of a result in the files for LAMMPS; these are a
/// pair_style eam/fs each, over those of the pairs.
#pragma once

#include "export/export_engine.h"

/// Whether LAMMPS has a law as it is: all but tables, dihedrals with a C_5, and phases that are no
/// whole degrees.
bool mf_export_lammps_has_law(const struct bonded_curve *curve);

/// Find the one number of bonds up to which all molecules exclude pairs, job->exclude: LAMMPS has
/// one for all. Fails: BAD_INPUT if there is none; NO_MEMORY.
enum status mf_export_lammps_check(struct export_job *job) MUST_USE;

/// Numbers of terms and of their types, for the head of the data file.
void mf_export_lammps_counts(const struct export_job *job, FILE *stream);

/// Molecule of a bead, from 1 on; 0: a single one.
size_t mf_export_lammps_molecule(const struct export_model *model, size_t particle);

/// The sections Bonds, Angles and Dihedrals.
void mf_export_lammps_terms(const struct export_job *job, FILE *stream);

/// The sections of the table file.
void mf_export_lammps_tables(const struct export_job *job, FILE *stream);

/// Styles of the terms, which stand before the data is read, and their coefficients, after.
void mf_export_lammps_styles(const struct export_job *job, FILE *stream);
void mf_export_lammps_coefficients(const struct export_job *job, FILE *stream);

/// The data file: box, masses, positions, velocities, terms; the table file: all potentials and
/// friction weights; the input up to the bonds, which reads data.mesofit.
void mf_export_lammps_print_data(const struct export_job *job, FILE *stream);
void mf_export_lammps_print_table(const struct export_job *job, FILE *stream);
void mf_export_lammps_print_system(const struct export_job *job, FILE *stream);

/// How far apart beads of one term may be [λ]; 0 without molecules.
double mf_export_lammps_reach(const struct export_model *model);

/// Whether there are energies of local densities, so that styles overlay each other.
bool mf_export_lammps_overlays(const struct export_job *job);

/// "NAME.eam.fs" of each, in LAMMPS's format. Fails: IO.
enum status mf_export_lammps_write_densities(const struct export_job *job) MUST_USE;

/// The end of the command of styles, after those of the pairs, and the commands of coefficients.
void mf_export_lammps_density_styles(const struct export_job *job, FILE *stream);

void mf_export_lammps_density_coefficients(const struct export_job *job, FILE *stream);
