// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the engines that a Python script drives have in common: tables and a start as columns
/// of numbers.
#pragma once

#include "export/export_engine.h"

/// Write for each pair type and curve A-B.txt, rows r, Φ, F. Fails: IO.
enum status mf_export_script_tables(const struct export_job *job) MUST_USE;

/// The same, and start.txt: type, position, velocity. Fails: IO.
/// @param[in] shift  what is taken off positions, as a share of the box
enum status mf_export_script_files(const struct export_job *job, double shift) MUST_USE;

/// Print the imports, of `module` last, and the numbers that all scripts begin with: `box`, `kT`,
/// `temperature` and `pressure_unit`, a pressure of the README over one of the script's units,
/// `time_step`, `types`, `masses`, `pairs` (types a and b, file, cutoff, and γ and r_c of the
/// friction), `dpd`, whether that runs, and `slowing`, the time of a bath instead.
void mf_export_script_head(const struct export_job *job, const char *module, FILE *stream);

/// Print what a line of the script's output has: temperature, pressure in the units that the README
/// has, too, the potential energy of all beads and, with `density`, their density.
void mf_export_script_columns(const struct export_job *job, bool density, FILE *stream);

/// What the README says of the thermostat of such a script.
void mf_export_script_explain(const struct export_job *job, const char *dpd, FILE *stream);

/// The same of engines whose friction also acts between pairs that molecules exclude.
void mf_export_script_excluded(const struct export_job *job, FILE *stream);

/// Write bonds.txt, angles.txt, dihedrals.txt (group and beads, from 0 on), exclusions.txt (two
/// beads) and for each law that the engine has not its rows q, U, −dU/dq as bond0.txt, angle0.txt,
/// dihedral0.txt, …; lengths and angles [rad]. Without molecules nothing is written. Fails: IO.
enum status mf_export_terms_files(const struct export_job *job) MUST_USE;

/// Print the lines that read them: `terms`, for each kind that there is its groups (name, law, its
/// numbers by the names of our scenes) and its rows, and `excluded`. Angles are in radians; a table
/// has a "file".
void mf_export_terms_head(const struct export_job *job, FILE *stream);
