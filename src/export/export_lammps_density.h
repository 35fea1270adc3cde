// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Energies of local densities in the files for LAMMPS: a pair_style eam/fs for each, over
/// those of the pairs.
#pragma once

#include "export/export_engine.h"

/// Whether there are any, so that styles overlay each other.
bool mf_export_lammps_overlays(const struct export_job *job);

/// "NAME.eam.fs" of each, in LAMMPS's format. Fails: IO.
enum status mf_export_lammps_write_densities(const struct export_job *job) MUST_USE;

/// The end of the command of styles, after those of the pairs, and the commands of coefficients.
void mf_export_lammps_density_styles(const struct export_job *job, FILE *stream);
void mf_export_lammps_density_coefficients(const struct export_job *job, FILE *stream);
