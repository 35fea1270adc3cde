// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Which ranks have not been heard of for long.
///
/// A rank that works says so every few seconds by a thread of its own, however long its task takes:
/// one that is silent hangs, or its computer or network does. It is named; nothing else is done,
/// since it may come back.
#pragma once

#include <stdbool.h>

/// Seconds without a word after which a rank is named, and between its words.
enum { RANKS_WATCH_PATIENCE = 60, RANKS_WATCH_WORD = 5 };

struct ranks_watch {
    struct ranks_watch_one {
        double heard; ///< clock [s]
        bool named, left;
    } * one;       ///< shape [ranks]
    double said;   ///< clock of this rank's last word [s]
    double looked; ///< clock of the last look at the others [s]
};

/// All have just been heard of. The job ends where there is no memory.
void mf_ranks_watch_init(struct ranks_watch *watch);
void mf_ranks_watch_clear(struct ranks_watch *watch);

void mf_ranks_watch_hear(struct ranks_watch *watch, int rank);

/// This rank waits for the others and says nothing until then: it is not named.
void mf_ranks_watch_leave(struct ranks_watch *watch, int rank);

/// Whether this rank is to say that it works.
bool mf_ranks_watch_is_due(struct ranks_watch *watch);

/// Name those that are silent: rank 0 the others, rank 1 rank 0.
void mf_ranks_watch_look(struct ranks_watch *watch);
