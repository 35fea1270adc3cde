// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit measure`: from trajectories to a target.
#pragma once

#include "measure/frames.h"
#include "measure/measured.h"
#include "report/run_folder.h"

/// What the command line asks for.
struct measure_request {
    const char *structure, *map; ///< NULL: the trajectory itself, one bead a residue
    const char *molecules;       ///< of which beads are bonded to which; NULL: nobody tells
    const char *beads;           ///< file that the frames of beads are written to; NULL: none
    struct frames_plan frames;
    struct measured_plan measured;
    double temperature; ///< of the target [K]; NAN: that of the velocities
    int system;         ///< enum units_system, of what is written
};

/// Measure, and write target.json, tables, summary.json, used.json and figures into the folder.
/// Nothing is written there before the last frame.
/// Fails: BAD_INPUT, IO, NO_MEMORY; INTERRUPTED once what was measured up to then is written.
/// Tested: test_measure.
enum status mf_measure_run(const struct measure_request *request,
                           const struct run_options *options) MUST_USE;
