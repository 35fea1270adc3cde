// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What finished tasks have left, kept so that they need not be done again after an
/// interruption.
///
/// Work that is begun again from the same state comes to the same tasks. Those whose letters
/// (base/letter.h) are kept are not done: what they left is put into its place. So a checkpoint is
/// the state before an iteration and the letters of the tasks that it has finished, whatever
/// the method; a task whose letter is missing is done again, with the same bits.
#pragma once

#include "base/parallel.h"

/// Zeroed: nothing.
struct parallel_kept {
    uint64_t size; ///< of the letters [bytes]; the first span
    uint64_t room;
    char *letters;  ///< one behind the other
    uint64_t calls; ///< of mf_parallel_try since the work began
};

void mf_parallel_kept_clear(struct parallel_kept *kept);

/// From now on mf_parallel_try keeps letters there and takes those that are there, if its tasks
/// have `spans` and are no part of another task; NULL: it does not. Work begins here, from the
/// state to which the letters belong: calls are numbered from here.
void mf_parallel_keep(struct parallel_kept *kept);

/// What goes with a checkpoint: two spans. The length of the second is the first: after it was
/// restored there is to be made room. Tested: test_parallel_keep.
enum { PARALLEL_KEPT_SPANS = 2 };
size_t mf_parallel_kept_spans(struct parallel_kept *kept, struct memory_span *spans);
enum status mf_parallel_kept_make_room(struct parallel_kept *kept) MUST_USE;

/// @name For mf_parallel_try

/// Those of `tasks` that are to be done; `try` does them. Fails: as `try`; BAD_INPUT for letters of
/// other tasks.
enum status mf_parallel_keep_try(const struct parallel_tasks *tasks,
                                 enum status (*try)(const struct parallel_tasks *)) MUST_USE;
