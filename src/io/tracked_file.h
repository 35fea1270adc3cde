// SPDX-License-Identifier: GPL-3.0-or-later
/// @file One file of a folder that is open, by its name in that folder. Links are never followed.
#pragma once

#include "io/manifest.h"

enum tracked_file_state {
    TRACKED_FILE_ABSENT,
    TRACKED_FILE_AS_LEFT,
    TRACKED_FILE_OTHER,
    TRACKED_FILE_FOLDER
};

/// What is there in the place of a file, or of a folder, which is never TRACKED_FILE_FOLDER.
/// @param[in] entry  of the list, or NULL: it is not in it
enum tracked_file_state mf_tracked_file_state(int place, const char *name,
                                              const struct manifest_entry *entry);

/// Set size and digest of an entry to those of its file, whose size is known alone if it has more
/// than *bytes, which what is read is taken from; or set that it is gone.
void mf_tracked_file_seal(int place, struct manifest_entry *entry, int64_t *bytes);

/// Whether it is the name of a folder, which ends with /.
bool mf_tracked_file_is_folder(const char *name);

/// Whether there is a link in its place.
bool mf_tracked_file_is_link(int place, const char *name);

/// Remove a file, or a folder unless something is in it; 0, or the number of the error.
int mf_tracked_file_remove(int place, const char *name);

/// Remove what killed processes had begun of the files of a list, in the folder and in those that
/// it names.
void mf_tracked_file_remove_partial(const struct manifest *list);
