// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The folder of a measurement: a target for `mesofit fit`.
#pragma once

#include "input/scene_molecules.h"
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
    bool interrupted;
    double seconds;
};

/// Whether types of beads have different masses.
bool mf_measure_output_masses_differ(const struct measure_result *result);

/// Write the tables, target.json, summary.json and used.json. Fails: IO, NO_MEMORY.
enum status mf_measure_output_write(const struct measure_result *result) MUST_USE;
