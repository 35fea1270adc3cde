// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a finished fit left in its folder, read back.
#pragma once

#include "base/fields.h"
#include "base/status.h"
#include "io/units_scale.h"
#include "problem/targets.h"

#include <stddef.h>

/// Numbers and texts of summary.json; NAN or "" where it does not say.
struct result_summary {
    char status[FIELD_TEXT_SIZE], method[FIELD_TEXT_SIZE], version[FIELD_TEXT_SIZE];
    double seconds, threads, iterations, evaluations, engine_steps;
    double error_over_noise; ///< of all targets, in which 1 is what statistics leave
    char worst[64];          ///< the target that is farthest off by its noise, and how far
    struct result_distance {
        double rmse, rmse_error, noise;
    } distance[TARGETS]; ///< from each kind of targets
    double diffusion, diffusion_error, diffusion_cm2_per_s, diffusion_error_cm2_per_s;
    double truth_rms, truth_ramp, truth_rms_without_ramp; ///< of a potential
    double omega_truth_rms;                               ///< of a friction weight
    double temperature, temperature_error;
    double temperature_configurational, temperature_configurational_error;
    double potential_energy, potential_energy_error;
    double pressure, pressure_error;
    double density, density_error; ///< of fits at constant pressure
    double kirkwood_buff, kirkwood_buff_error, compressibility, compressibility_error;
    double ramp_error, ramp_pressure, pressure_left_open, density_left_open; ///< of an inversion
    double directions;                                                       ///< the same
    double seed;
    double length_unit_nm; ///< λ
    struct units units;    ///< in which all of them are; no scale: unknown
};

/// Number or text n of summary.json, which may be made in `capacity`; NULL beyond the last.
/// Distances are called "rdf_rmse", "rdf_rmse_error", "rdf_noise", and so on for every kind of
/// targets.
struct result_field {
    char name[64], unit[UNITS_NAME_SIZE];
    struct field field;
};
const struct field *mf_result_summary_field(size_t n, struct result_field *capacity);

/// Some columns of a table; no rows if there is no such table. Unlike a measurement, a result may
/// hold nan: not known.
struct result_table {
    size_t rows, columns;
    double *values; ///< shape [rows, columns], row-major
};

struct result {
    struct result_summary summary;
    struct result_table rdf; ///< r, target, target_error, result, result_error
    struct result_table etd; ///< time, r0, target, target_error, result, result_error; a row a cell
    struct result_table vacf;      ///< time, target, target_error, result, result_error
    struct result_table potential; ///< r, phi, phi_error, truth; only if it was fitted
    struct result_table omega;     ///< r, omega, omega_error, truth; only if it was fitted
    struct result_table course;    ///< iteration, evaluations, engine_steps, seconds, error, noise
};

/// Read summary.json, history.tsv and timing.tsv of a fit's folder, and as far as they are there
/// rdf.tsv, etd_cells.tsv, vacf.tsv, potential.tsv and omega.tsv. Of a simulation's folder,
/// summary.json, and rdf.tsv, etd.tsv and motion.tsv if they are there: results without a target.
/// BAD_INPUT or IO with one line that names the file; *result is then empty. Tested: test_compare.
enum status mf_result_read(struct result *result, const char *folder) MUST_USE;

void mf_result_clear(struct result *result);
