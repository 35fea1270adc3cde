// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What ranks write to each other while they share tasks: a head, then bytes.
#pragma once

#include "base/parallel.h"

#include <stdbool.h>

enum letter_kind {
    // while tasks are shared
    LETTER_ASK,    ///< a thread of the sender is free
    LETTER_TASK,   ///< do this one; LETTER_NO_TASK: there is none left
    LETTER_RESULT, ///< what a task left, or its message if it failed
    LETTER_WISH,   ///< the sender was asked to stop by the signal `task`
    LETTER_STOP,   ///< all stop, as that signal wants it
    LETTER_ALIVE,  ///< and its answer
    LETTER_OVER,   ///< all is done
    LETTER_READY,  ///< to share what was found
    // between
    LETTER_ARRIVED, ///< at mf_parallel_agree, with a status, its message, and a digest as `task`
};

#define LETTER_NO_TASK UINT64_MAX

struct letter {
    uint64_t turn; ///< which call of mf_parallel_try or mf_parallel_agree it belongs to
    uint64_t task;
    uint64_t bytes; ///< behind this head
    double seconds; ///< of processor time that a task took
    uint32_t kind;
    int32_t status;
};

/// The number of the next call of mf_parallel_try or mf_parallel_agree: the same on all ranks.
uint64_t mf_letter_turn(void);

static inline void *letter_bytes(const struct letter *letter) {
    return (void *)(letter + 1);
}

/// Bytes that a letter takes among others, with its head: whole words.
static inline size_t letter_room(const struct letter *letter) {
    return (sizeof *letter + letter->bytes + sizeof(uint64_t) - 1) / sizeof(uint64_t) *
           sizeof(uint64_t);
}

/// A head with the bytes of what its task leaves.
struct letter mf_letter_sized(const struct letter *head, const struct parallel_tasks *tasks);

/// Write what a task leaves behind such a head: its result, and its part of the context.
void mf_letter_write(struct letter *letter, const struct parallel_tasks *tasks, const void *result);

/// Put what a task left into the context; false if it does not fit.
/// @param[out] result  in the letter; NULL if it has none
bool mf_letter_read(const struct letter *letter, const struct parallel_tasks *tasks,
                    const void **result);

/// New memory, or the end of the job where there is none: the others would wait for this rank.
void *mf_letter_or_stop(void *memory);

/// A letter with this head and room for its bytes, to be freed by mf_memory_free. The job ends
/// where there is no memory for it.
struct letter *mf_letter_new(const struct letter *head);

/// The same with a message, and with what a task leaves: its result, and its part of the context.
struct letter *mf_letter_of_message(const struct letter *head, const char *message);
struct letter *mf_letter_of_task(const struct letter *head, const struct parallel_tasks *tasks,
                                 const void *result);

/// Send a letter; a head alone is one of no bytes.
void mf_letter_send(int to, const struct letter *letter);

/// A letter of this turn or a later one, if one has arrived, else NULL. To be freed.
struct letter *mf_letter_receive(uint64_t turn, int *from);

/// Put what a task left on another rank into the context.
/// @return its result in the letter; NULL if it has none. The job ends where it does not fit.
const void *mf_letter_unpack(const struct letter *letter, const struct parallel_tasks *tasks);

/// A rank that does not do what rank 0 does has failed alone, or is of another mind: end the job.
_Noreturn void mf_letter_stop_strayed(int from, const struct letter *letter);
