// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How many threads take part in turns of the same work: as many as pay.
///
/// Threads that meet often are slower than one thread where turns are short or other processes
/// keep the cores busy. A crew tries both now and then, and goes on with what took less time. Only
/// work whose bits do not depend on the number of threads may be given to it.
#pragma once

#include <stdint.h>

enum { CREW_TRIED_TURNS = 9, CREW_FIRST_REST = 128, CREW_LONGEST_REST = 4096 };

struct crew {
    int most;                            ///< threads that may be taken
    int now;                             ///< threads of the next turn: 1 or `most`
    int better;                          ///< of the last trial
    int turn;                            ///< turns since the last trial ended, or of this one
    int rest;                            ///< turns from trial to trial; 0: a trial is running
    int next_rest;                       ///< doubled as long as trials agree
    uint64_t tried[2][CREW_TRIED_TURNS]; ///< times of turns with `most` threads, with one
};

/// A crew of at most `most` threads; with one there is nothing to try.
void mf_crew_init(struct crew *crew, int most);

/// A turn with crew->now threads took `ticks`: settle crew->now for the next one.
void mf_crew_end_turn(struct crew *crew, uint64_t ticks);
