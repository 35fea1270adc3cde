// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A folder for a while: tables of a simulation that runs, beneath TMPDIR or /tmp.
///
/// Its list of files (io/tracked_files.h) says what it is. The process that made it holds a lock on
/// it, which the system takes back however the process ends: one with a list and without a lock is
/// left over from a process that was killed, and who makes the next one removes what is in that
/// list, if it is of the same user.
#pragma once

#include "io/tracked_files.h"

struct live_scratch {
    char path[OUTPUT_PATH_SIZE]; ///< "": there is none
    struct tracked_files own;
};

/// Make one, and remove those that are left over. Without a place for it the path is "". It must
/// not be moved. Tested: test_live_scratch.
void mf_live_scratch_make(struct live_scratch *scratch);

/// Remove it with its files.
void mf_live_scratch_remove(struct live_scratch *scratch);
