// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a finished fit left in its folder, read back.
#pragma once

#include "base/fields.h"
#include "base/status.h"

#include <stddef.h>

/// Numbers and texts of summary.json; NAN or "" where it does not say.
struct result_summary {
    char status[FIELD_TEXT_SIZE], method[FIELD_TEXT_SIZE], version[FIELD_TEXT_SIZE];
    double seconds, threads, iterations, evaluations, engine_steps;
    double rdf_rmse, rdf_rmse_error, rdf_noise;
    double temperature, temperature_configurational, pressure;
    double seed;
};

extern const struct field result_summary_fields[];

/// The first columns of a table. Unlike a measurement, a result may hold nan: not known.
struct result_table {
    size_t rows, columns;
    double *values; ///< shape [rows, columns], row-major
};

struct result {
    struct result_summary summary;
    struct result_table rdf;       ///< r, target, target_error, result, result_error
    struct result_table potential; ///< r, phi
    struct result_table history;   ///< iteration, evaluations, engine_steps, error, noise
    struct result_table timing;    ///< iteration, seconds
};

/// Read summary.json, rdf.tsv, potential.tsv, history.tsv and timing.tsv of a fit's folder.
/// BAD_INPUT or IO with one line that names the file; *result is then empty.
/// Tested: test_compare.
enum status result_read(struct result *result, const char *folder) MUST_USE;

void result_clear(struct result *result);
