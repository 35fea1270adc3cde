// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The folder that a run writes.
#pragma once

#include "base/status.h"
#include "scene/run_options.h"
#include "io/input.h"
#include "io/json_write.h"
#include "io/tracked_files.h"
#include "io/output.h"

#include <stdbool.h>
#include <stdint.h>

/// How far a run is, while it works: report/progress.h.
#define PROGRESS_FILE "progress.json"

/// The folder of the folders of a fit's states.
#define STATES_FOLDER "states"

/// A simulation or a measurement may replace an earlier one of its kind that is finished, a fit
/// nothing without --force.
enum run_kind { RUN_SIMULATION, RUN_FIT, RUN_MEASUREMENT };

/// A folder while a run writes it. Zeros are one that is not open. One that is open must not be
/// moved.
struct run_folder {
    char path[OUTPUT_PATH_SIZE];
    struct tracked_files own;
    struct output used; ///< used.json, until the run has begun
    char *settings;     ///< what stands in it
    size_t settings_size;
    bool no_figures; ///< as the options say
};

/// Set the path of the folder of a run of `input`, and nothing else. Fails: BAD_INPUT if it is too
/// long.
enum status mf_run_folder_choose(struct run_folder *folder, enum run_kind kind, const char *input,
                                 const struct run_options *options) MUST_USE;

/// Choose, make and lock the folder of a run of `input`, `out` beside it unless the options say
/// where, and `target` here for a measurement, in which nothing changes before
/// mf_run_folder_begin. Of several ranks (base/ranks.h) rank 0 alone does so. Fails: BAD_INPUT if
/// the path is too long, the folder is a link or has links to folders of results, another process
/// runs in it, a file that the run reads would be replaced, there is nothing to resume, or there
/// are results that only --force may replace: those of an earlier fit, an unfinished simulation, a
/// simulation if this is a fit, and what a person has changed since; results that no list says the
/// program wrote, unless the run goes on; IO. Tested: test_folder.
enum status mf_run_folder_open(struct run_folder *folder, enum run_kind kind, const char *input,
                               const struct input_files *inputs,
                               const struct run_options *options) MUST_USE;

/// Refuse now what would be refused when the file of this name is written. Fails: BAD_INPUT.
enum status mf_run_folder_reserve(struct run_folder *folder, const char *name) MUST_USE;

/// Keep the settings, for used.json, which is not written yet. @param[out] digest  of them
/// Fails: NO_MEMORY.
enum status mf_run_folder_keep_settings(struct run_folder *folder, const struct json_writer *writer,
                                        uint64_t *digest) MUST_USE;

/// Begin a run that is not resumed: its results will be its own, what is there is of an earlier
/// one. There is room for used.json. Fails: IO; as mf_tracked_files_claim.
enum status mf_run_folder_begin(struct run_folder *folder, uint64_t digest) MUST_USE;

/// The run has begun, its checkpoint is there if it has one: give used.json its name, and remove
/// what an earlier run left, so that a folder never mixes two. Fails: IO.
enum status mf_run_folder_take_over(struct run_folder *folder) MUST_USE;

/// The run goes on from its checkpoint: finish what it may have begun to take over, and leave
/// used.json alone if it is there. Fails: IO; as mf_tracked_files_claim.
enum status mf_run_folder_resume(struct run_folder *folder, uint64_t digest) MUST_USE;

/// Unlock it.
void mf_run_folder_close(struct run_folder *folder);

/// Path of a file in the folder, into `path` of OUTPUT_PATH_SIZE bytes.
void mf_run_folder_file(const struct run_folder *folder, const char *name, char *path);

/// The folder of a state of a fit in that of the fit, which is made with it; what is written there
/// is the fit's. Fails: BAD_INPUT if its path is too long or a link leads there; IO.
enum status mf_run_folder_state(const struct run_folder *folder, const char *name,
                                struct run_folder *state) MUST_USE;

/// Refuse now what would be refused then, and a folder that holds a run of its own.
enum status mf_run_folder_check_state(struct run_folder *folder, const char *name) MUST_USE;

/// Draw the figures of the folder, unless the options say that there are to be none; what fails is
/// a warning on stderr, and false is returned.
bool mf_run_folder_draw(const struct run_folder *folder);
