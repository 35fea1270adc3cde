// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the next events of the kinetic gas need is fetched from memory before.
///
/// Who is next stands anywhere in memory, but the calendar knows it before: each event leads, in
/// stages, to the lines of memory that it will read. A processor drops what it is asked to fetch
/// while some twenty lines are under way, so that all wait in a queue, of which each search for
/// neighbours begins with a few. What is wrong or comes too late costs time, but nothing else.
/// Tested: test_hard_gas (unit), by the bits.
#pragma once

#include "dynamics/hard_gas.h"

enum { HARD_GAS_COMING = 64, HARD_GAS_LINES = 512, HARD_GAS_FOUND = 54 };

/// Cells from `low` to `high` on each axis.
struct hard_gas_block {
    int low[3], high[3];
};

/// A body whose event comes.
struct hard_gas_coming {
    double time;
    int32_t body;                      ///< −1: the entry was void
    int32_t partner;                   ///< −1: it crosses the border of its cell
    struct hard_gas_block own, others; ///< where the two will look
    int found;
    int32_t first[HARD_GAS_FOUND]; ///< of the cells of these
};

struct hard_gas_fetch {
    uint32_t at_once;              ///< lines that are begun with together
    uint32_t bodies, asked, begun; ///< so many since the start; each array has the last of them
    struct hard_gas_coming coming[HARD_GAS_COMING];
    const void *line[HARD_GAS_LINES];
};

/// Make the queue.
enum status mf_hard_gas_fetch_init(struct hard_gas *gas) MUST_USE;

/// Ask for what the events of a bucket some time ahead need.
void mf_hard_gas_fetch_ask(struct hard_gas *gas);

/// Begin with some of what was asked for. NULL: nothing is fetched.
static inline void hard_gas_fetch_some(struct hard_gas_fetch *fetch) {
    if (fetch && fetch->asked - fetch->begun > HARD_GAS_LINES)
        fetch->begun = fetch->asked - HARD_GAS_LINES; // too late for the others
    for (uint32_t n = 0; fetch && n < fetch->at_once && fetch->begun != fetch->asked; n++)
        __builtin_prefetch(fetch->line[fetch->begun++ % HARD_GAS_LINES]);
}
