// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The list of the files that this program wrote into a folder, as it stands in that folder.
///
/// A text that only grows, a line for what happens: "begin DIGEST" (a run begins, and what stands
/// before is of earlier ones), "keep" (it did not come so far), "-", "-" and a name between tabs (a
/// file is about to come or to change), its digest, bytes and name (a file as it was left), "gone",
/// "-" and its name. Of a name the last line counts. A line that is cut short, or is none of these,
/// says nothing.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct manifest_entry {
    char *name;      ///< seen from the folder; that of a folder ends with /
    int64_t bytes;   ///< as it was left; −1: not known
    uint64_t digest; ///< of those, if `digested`
    bool digested;
    bool gone;    ///< it was there once
    bool earlier; ///< of a run before the last that began
    bool claimed; ///< by this process
};

struct manifest {
    int place;                    ///< the folder, open
    const char *folder;           ///< its path, for messages
    const char *name;             ///< of the list's file
    int file;                     ///< open to be written; −1: not yet
    struct manifest_entry *entry; ///< in the order in which they came
    size_t count, capacity;
    size_t *number; ///< by the digest of a name, shape [2 room]: that of its entry from 1 on, or 0
    uint64_t began; ///< digest of the last run that began
    bool there;     ///< the file
    bool later;     ///< its lines come to the disk with what else is to come there later (output.h)
};

/// Read the list, of which place, folder and name are set; a folder without one has an empty one.
/// Fails: IO, NO_MEMORY; BAD_INPUT if it is a link or no file.
enum status mf_manifest_read(struct manifest *list) MUST_USE;
void mf_manifest_clear(struct manifest *list);

/// The entry of a name, or NULL if there is none or it is gone.
struct manifest_entry *mf_manifest_find(const struct manifest *list, const char *name);

/// Add an entry, or make the one that there is new, in memory alone. Fails: NO_MEMORY.
enum status mf_manifest_add(struct manifest *list, const char *name,
                            struct manifest_entry **entry) MUST_USE;

/// Whether a name may stand in a list: it stays in the folder, and in its line.
bool mf_manifest_accepts(const char *name);

/// @name Lines of the file, whole or not at all, and on the disk; made if there is none. Fail: IO.
/// A run begins: all entries are of earlier ones; or it did not come so far, and none is; and
/// entries as they are now.
enum status mf_manifest_begin(struct manifest *list, uint64_t digest) MUST_USE;
enum status mf_manifest_keep(struct manifest *list) MUST_USE;
enum status mf_manifest_enter(struct manifest *list, struct manifest_entry *const *entry,
                              size_t count) MUST_USE;

/// Write the file again, without what is gone or of an earlier run. If that fails, the old one says
/// the same.
void mf_manifest_compact(struct manifest *list);
