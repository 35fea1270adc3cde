// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Processes of one job that share the work of a run: ranks, as MPI numbers them.
///
/// All ranks run the same program on the same input and keep the same state, bit by bit; what they
/// share is independent tasks (base/parallel.h). Rank 0 leads: it alone hands out, writes and
/// speaks. ranks.c is the only file that knows MPI; a build without it has ranks_none.c, where a
/// process is alone. One thread at a time may call what sends, receives or shares.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Meet the other ranks of the job. `warn` is told lines for a person.
/// Fails: BAD_INPUT if the process is one of several and the program was built without MPI.
enum status mf_ranks_begin(void (*warn)(const char *line)) MUST_USE;

/// Wait for all ranks, then part. Nothing if mf_ranks_begin was not called.
void mf_ranks_end(void);

/// Ranks of the job, and the number of this one; 1 and 0 before mf_ranks_begin.
int mf_ranks_count(void);
int mf_ranks_number(void);

static inline bool ranks_lead(void) {
    return mf_ranks_number() == 0;
}

/// The computer that a rank runs on.
const char *mf_ranks_host(int rank);

/// Send a letter of `words` to a rank. Small letters from one rank to another
/// arrive in their order; one may overtake a large one.
void mf_ranks_send(int to, const uint64_t *letter, size_t words);

/// Receive a letter if one has arrived; NULL if none has. It is freed by mf_memory_free.
uint64_t *mf_ranks_receive(int *from, size_t *words);

/// Give all ranks the bytes of rank 0. All ranks call it, with as many bytes.
void mf_ranks_share(void *memory, size_t bytes);

/// Let a moment pass for which there is nothing to do: shorter than any task, longer than a turn of
/// the processor.
void mf_ranks_rest(void);

/// Tell a person.
void mf_ranks_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/// End all ranks at once, after a line for a person.
_Noreturn void mf_ranks_stop(int exit_code, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
