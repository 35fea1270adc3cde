// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Processes of an MPI job that share the work of a fit.
///
/// All ranks run the same program on the same input and keep the same state, bit by bit; what they
/// share is independent tasks (mf_parallel_try). Rank 0 alone writes and prints. ranks.c is the
/// only file that knows MPI; a build without it has ranks_none.c, where a process is alone.
#pragma once

#include "base/memory.h"
#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Begin MPI. Signals from now on stop all ranks at the same place (base/interrupt.h).
/// Fails: BAD_INPUT if the process is one of several and the program was built without MPI.
enum status mf_ranks_begin(void) MUST_USE;

/// Wait for all ranks, and end MPI. Nothing if mf_ranks_begin was not called.
void mf_ranks_end(void);

/// Ranks of the job, and the number of this one; 1 and 0 before mf_ranks_begin.
int mf_ranks_count(void);
int mf_ranks_number(void);

static inline bool ranks_lead(void) {
    return mf_ranks_number() == 0;
}

/// Collective error check: all ranks return the same status and message, rank 0's if it failed,
/// else that of the lowest rank that did, with its name. Each rank calls it between the same tasks;
/// one that is elsewhere, as it failed or computes something else, ends the job with one line.
/// @param[in] digest  of what all ranks must have computed alike; BAD_INPUT if one has not
enum status mf_ranks_check(enum status status, uint64_t digest) MUST_USE;

/// Give all ranks this state of rank 0. All call it, with as many spans of the same lengths.
void mf_ranks_broadcast(const struct memory_span *spans, size_t count);

/// What mf_parallel_try does where there are several ranks: rank 0 hands out the tasks in their
/// order, one to each thread of any rank that is free, and all ranks have all results at the end.
struct parallel_call;
void mf_ranks_try(struct parallel_call *call);
