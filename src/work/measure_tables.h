// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The tables of a measurement.
#pragma once

#include "io/json_write.h"
#include "work/measure_output.h"

/// Whether any window of motion is complete; and any of escape times.
bool mf_measure_tables_have_motion(const struct measure_result *result);
bool mf_measure_tables_have_etd(const struct measure_result *result);

/// Write rdf.tsv or those of pair types; structure_factor.tsv, density_profile.tsv, msd.tsv,
/// vacf.tsv, etd.tsv, etd_error.tsv and etd_bins.tsv as far as they were measured. Fails: IO,
/// NO_MEMORY.
enum status mf_measure_tables_write(const struct measure_result *result) MUST_USE;

/// Fails: NO_MEMORY.
enum status mf_measure_scene_write(const struct measure_result *result,
                                   struct json_writer *writer) MUST_USE;
