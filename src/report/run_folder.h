// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The folder that a run writes.
#pragma once

#include "base/status.h"
#include "input/run_options.h"
#include "io/input.h"
#include "io/output.h"
#include "system/composition.h"

#include <stdbool.h>
#include <stdint.h>

/// How far a run is, while it works: report/progress.h.
#define PROGRESS_FILE "progress.json"

/// The folder of the folders of a fit's states.
#define STATES_FOLDER "states"

/// A simulation or a measurement may replace an earlier one of its kind, a fit nothing without
/// --force.
enum run_kind { RUN_SIMULATION, RUN_FIT, RUN_MEASUREMENT };

/// A folder while a run writes it. Zeros are one that is not open.
struct run_folder {
    char path[OUTPUT_PATH_SIZE];
    bool locked;
    int lock; ///< the folder, open
};

/// Set the path of the folder of a run of `input`, and nothing else. Fails: BAD_INPUT if it is too
/// long.
enum status mf_run_folder_choose(struct run_folder *folder, enum run_kind kind, const char *input,
                                 const struct run_options *options) MUST_USE;

/// Choose, make and lock the folder of a run of `input`, `out` beside it unless the options say
/// where, and `target` here for a measurement, in which nothing changes before
/// mf_run_folder_begin. Of several ranks (base/ranks.h) rank 0 alone does so. Where files cannot be
/// locked, it goes on without. Fails: BAD_INPUT if the path is too long, another process runs in
/// the folder, a file that the run reads has the name of a result, there is nothing to resume, or
/// there are results that only
/// --force may replace: those of an earlier fit, of a simulation if this is a fit, and files with
/// such names that are of no run (there is no used.json); IO. Tested: test_folder.
enum status mf_run_folder_open(struct run_folder *folder, enum run_kind kind, const char *input,
                               const struct input_files *inputs,
                               const struct run_options *options) MUST_USE;

/// Remove what killed processes had begun to write and, unless the run goes on with them, the
/// results of an earlier run, so that a folder never mixes two: once used.json and checkpoint.bin
/// are those of the new run, which so has room to begin. Fails: IO.
enum status mf_run_folder_begin(const struct run_folder *folder, bool resume) MUST_USE;

/// Whether a run writes files of this name beside used.json.
bool mf_run_folder_is_result(const char *name);

/// Unlock it.
void mf_run_folder_close(struct run_folder *folder);

/// Path of a file in the folder, into `path` of OUTPUT_PATH_SIZE bytes.
void mf_run_folder_file(const struct run_folder *folder, const char *name, char *path);

/// The folder of a state of a fit in that of the fit, which is made with it; it is not locked by
/// itself. Fails: BAD_INPUT if its path is too long; IO.
enum status mf_run_folder_state(const struct run_folder *folder, const char *name,
                                struct run_folder *state) MUST_USE;

/// Find out whether that folder can be written, as mf_run_folder_open: refused are a link, a folder
/// with a run of its own, and one with a file that the run reads. And remove from it what an
/// earlier run left, as mf_run_folder_begin.
enum status mf_run_folder_open_state(const struct run_folder *folder, const char *name,
                                     const struct input_files *inputs) MUST_USE;
enum status mf_run_folder_begin_state(const struct run_folder *folder, const char *name,
                                      bool resume) MUST_USE;

/// Draw the figures of the folder; what fails is a warning on stderr.
void mf_run_folder_draw(const struct run_folder *folder);
