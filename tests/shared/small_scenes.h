// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Small scenes for tests of `mesofit simulate`, and the tables that they leave.
#pragma once

#include "shared/run_program.h"
#include "shared/temporary_folder.h"

/// The fluid of Groot and Warren (1997): density 3, a = 25, sigma^2 = 4.5, time step 0.04.
extern const char small_scenes_dpd[];
/// A mixture of 120 A and 180 B; B-B is without a potential.
extern const char small_scenes_mixture[];
/// NVE, with a range of g(r) beyond the cutoff.
extern const char small_scenes_nve[];

/// Enough samples to be interrupted, in the place of those of a scene.
#define SMALL_SCENES_LONG_MEASURE                                                                  \
    "\"measure\": {\"equilibration\": 1200, \"samples\": 60, \"every\": 20}"

/// Diffusion in windows of 24 steps, whose samples do not fall in with the others.
#define SMALL_SCENES_MOTION "\"motion\": {\"every\": 3, \"lags\": 8, \"origin_every\": 2}, "

/// g(r) from forces.
#define SMALL_SCENES_FORCE_RDF "\"rdf\": {\"estimator\": \"force\", \"range\": 2}, "

/// Tables of a scene, of a mixture, and of one with SMALL_SCENES_MOTION; NULL-terminated.
extern const char *const small_scenes_tables[];
extern const char *const small_scenes_mixture_tables[];
extern const char *const small_scenes_moving_tables[];

/// Write scene.json, `from` replaced by `to` unless it is NULL.
void small_scenes_write(struct temporary_folder *folder, const char *text, const char *from,
                        const char *to);

/// `mesofit simulate scene.json -o out`, which ends well.
void small_scenes_simulate(struct run_program_result *result, const char *out);
