// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The folder of a measurement: a target for `mesofit fit`.
#pragma once

#include "scene/scene_molecules.h"
#include "report/progress.h"
#include "io/json_write.h"
#include "work/measure_run.h"

/// A measurement that is over.
struct measure_result {
    const struct measure_request *request;
    const struct frames *frames;
    const struct mapping *mapping;
    const struct measured *measured;
    const struct scene_molecules *kinds; ///< that the beads are, or NULL
    struct units units;
    const char *folder;
    const char *drift; ///< warning of what changes along the trajectory, or ""
    bool interrupted;
    double seconds;
};

/// Whether types of beads have different masses, or masses that are not known.
bool mf_measure_output_masses_may_differ(const struct measure_result *result);

/// Whether there is nothing but molecules that do not see each other, of which there is no g(r): in
/// no box, or a single one.
bool mf_measure_output_is_alone(const struct measure_result *result);

/// Relative error of the kinetic temperature by equipartition, if all frames were independent.
double mf_measure_output_temperature_scatter(const struct measure_result *result);

/// Number density of all beads [1/nm³]; temperature [K], as given or the kinetic one, NAN if
/// neither is known; mean mass of a type's beads [u], NAN if it is not known.
double mf_measure_output_density(const struct measure_result *result);
double mf_measure_output_temperature(const struct measure_result *result);
double mf_measure_output_mass(const struct measure_result *result, int type);

/// "mass", of a mixture that of each type, if it is known.
void mf_measure_output_write_masses(const struct measure_result *result,
                                    struct json_writer *writer);

/// Write the tables, target.json, summary.json and used.json. Fails: IO, NO_MEMORY.
enum status mf_measure_output_write(const struct measure_result *result) MUST_USE;

/// Print a line for each thing that a person is to know. Fails: NO_MEMORY.
enum status mf_measure_print(struct progress *progress,
                             const struct measure_result *result) MUST_USE;

/// Say that a trajectory does not tell what its atoms are, and which file may.
void mf_measure_print_nameless(struct progress *progress, const char *file);

/// Say which command fits what was measured, where one can.
void mf_measure_print_next(struct progress *progress, const struct measure_result *result);

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
