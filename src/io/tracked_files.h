// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Which files of a folder are this program's own: it replaces and removes no others.
///
/// A folder that it writes holds a list of them. A name comes into the list before its file comes
/// into the folder, so that the list is right whenever the program is killed; when the folder is
/// closed, size and digest are added, by which a file is known that a person has changed since.
/// While a folder is open, whatever io/output.h writes in it goes through here by itself.
#pragma once

#include "io/input.h"
#include "io/output.h"
#include "io/manifest.h"

/// Names of the lists: who writes into a folder owns what its like has written.
#define TRACKED_FILES_OF_RUN ".mesofit-run"
#define TRACKED_FILES_OF_EXPORT ".mesofit-export"
#define TRACKED_FILES_OF_IMPORT ".mesofit-import"
#define TRACKED_FILES_OF_COMPARISON ".mesofit-compare"
#define TRACKED_FILES_OF_LIVE ".mesofit-live"

/// A folder that is open. It must not be moved.
struct tracked_files {
    char folder[OUTPUT_PATH_SIZE];
    struct manifest list;
    const struct input_files *inputs; ///< that are never replaced or removed, or NULL
    const char *goes_on_from; ///< the file that a run goes on from, of this name; NULL: none does
    bool force;               ///< also what is not its own may be replaced
    bool open;
    bool alone; ///< locked
    bool made;  ///< the folder
    bool begun; ///< and what is of earlier runs is still there
    struct tracked_files *next;
};

/// Open a folder and read its list, or make it before. Until it is closed, the program notices if
/// it is removed or another takes its place. Fails: BAD_INPUT if it is a link; IO, NO_MEMORY.
enum status mf_tracked_files_make(struct tracked_files *own, const char *folder,
                                  const char *list) MUST_USE;
enum status mf_tracked_files_open(struct tracked_files *own, const char *folder,
                                  const char *list) MUST_USE;

/// Be the only process that writes there, until the folder is closed or the process ends. Where
/// files cannot be locked, it goes on without. Fails: BAD_INPUT if another one is.
enum status mf_tracked_files_lock(struct tracked_files *own) MUST_USE;

/// Whether a file of this name is there and its own; and whether there is anything but its own.
bool mf_tracked_files_has(const struct tracked_files *own, const char *name);
bool mf_tracked_files_has_others(const struct tracked_files *own);

/// Refuse to go on if files of its own are read; or if they were changed since, unless `force`.
/// Fails: BAD_INPUT. @param[in] but  names that are left out, NULL-terminated
enum status mf_tracked_files_protect_inputs(struct tracked_files *own,
                                            const char *const *but) MUST_USE;
enum status mf_tracked_files_check(struct tracked_files *own, const char *const *but) MUST_USE;

/// Refuse now what would be refused when a file of this name is written. Fails: BAD_INPUT.
enum status mf_tracked_files_reserve(struct tracked_files *own, const char *name) MUST_USE;

/// Begin: all that is its own is of earlier runs. `digest` is what this run will be known by when
/// it is resumed. Fails: IO.
enum status mf_tracked_files_begin(struct tracked_files *own, uint64_t digest) MUST_USE;

/// Remove what earlier runs have left that this one has not replaced, the folders that were made
/// for it if nothing else is in them, and what killed processes had begun to write. Fails: IO.
enum status mf_tracked_files_remove_earlier(struct tracked_files *own) MUST_USE;

/// Go on with a run: the same if it had begun, and else nothing is of earlier runs. Fails: IO.
enum status mf_tracked_files_resume(struct tracked_files *own, uint64_t digest) MUST_USE;

/// Enter a file, whoever wrote it: as it is, it is known to be of this run. Fails: IO, NO_MEMORY.
enum status mf_tracked_files_adopt(struct tracked_files *own, const char *name) MUST_USE;

/// Close the folder. What was begun and not swept stays its own; a folder that was made and in
/// which nothing was written is removed.
void mf_tracked_files_close(struct tracked_files *own);

/// Remove all that is its own and the list, and the folder if nothing else is in it, and close it.
void mf_tracked_files_remove_all(struct tracked_files *own);

/// @name By their paths, whatever folder they are in; where none is open, anything goes.
/// Before a file is written: enter it into the list. Fails: BAD_INPUT if a file is there that is
/// not its own, was changed since or is read, or if a link leads there; IO; NO_MEMORY.
/// @param[in] later  the file comes to the disk later (mf_output_open_later), as does its entry
enum status mf_tracked_files_claim(const char *path, bool later) MUST_USE;

/// Remove a file that is not wanted any more, if it is its own.
void mf_tracked_files_remove(const char *path);

/// Make a folder and those above it. Fails: BAD_INPUT if one of them is a link; IO.
/// @param[out] *done  false if it is in no open folder
enum status mf_tracked_files_make_folder(const char *path, bool *done) MUST_USE;
