// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Commands whose results replace those of earlier ones, for tests that get in their way.
///
/// Each is done to its end in "whole", beside a file of a person; whatever happened elsewhere, in
/// the end there are the same files.
#pragma once

#include "shared/run_program.h"
#include "shared/temporary_folder.h"

enum { REPLACED_FOLDERS_WORDS = 6 };

/// What is done first, and what replaces it; "-o" and a folder are added.
struct replaced_folder {
    const char *first[REPLACED_FOLDERS_WORDS], *second[REPLACED_FOLDERS_WORDS];
    const char *tables[3];
    bool resumes; ///< what was begun may go on
};

/// All of them, up to one without words.
extern const struct replaced_folder replaced_folders[];

/// Write the inputs of all to the working folder.
void replaced_folders_write_inputs(struct temporary_folder *folder);

/// Do the second thing in "whole".
void replaced_folders_make_whole(struct temporary_folder *folder,
                                 const struct replaced_folder *one);

/// Do the first one in a new folder.
void replaced_folders_begin(struct temporary_folder *folder, const struct replaced_folder *one,
                            const char *out);

/// Run words, with an option unless it is NULL; returns the exit code, or −n of signal n.
int replaced_folders_run(const char *const *words, const char *out, const char *option);
const char *replaced_folders_message(void); ///< what the last one said on stderr

/// Whatever was reached: go on with it, or do it again.
void replaced_folders_finish(const struct replaced_folder *one, const char *out);

/// The folder is as "whole" is; and the person's file is there.
void replaced_folders_assert_whole(const struct replaced_folder *one, const char *out);
void replaced_folders_assert_mine(const char *out);

void replaced_folders_remove(const char *folder);
