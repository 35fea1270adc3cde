// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a fit goes on from: its state before an iteration, and what the tasks of the
/// iteration that are done have left, so that they are not done again (base/task_log.h). An
/// interruption costs the tasks that were being done, and no more.
#pragma once

#include "base/task_log.h"
#include "report/history.h"

enum { FIT_CHECKPOINT_OWN = 3 + 3 * UNKNOWNS };

struct fit_checkpoint {
    const struct inverse_method *method; ///< with its state; borrowed
    void *state;
    struct history *history;                    ///< borrowed
    struct memory_span own[FIT_CHECKPOINT_OWN]; ///< what else changes, between iterations alone
    size_t owns;
    struct memory_image before; ///< the method's state before the iteration
    struct task_log tasks;      ///< of the iteration, or of the verification
};

void mf_fit_checkpoint_add(struct fit_checkpoint *checkpoint, void *memory, size_t bytes);

/// An iteration, or the verification, begins now. Fails: NO_MEMORY.
enum status mf_fit_checkpoint_begin(struct fit_checkpoint *checkpoint) MUST_USE;

/// Save what was before, and what is done since. Fails: IO.
enum status mf_fit_checkpoint_save(struct fit_checkpoint *checkpoint, const char *file,
                                   uint64_t digest) MUST_USE;

/// Fails: as mf_checkpoint_load; NO_MEMORY.
enum status mf_fit_checkpoint_load(struct fit_checkpoint *checkpoint, const char *file,
                                   uint64_t digest) MUST_USE;

/// What rank 0 has loaded, for the others. Fails: NO_MEMORY.
enum status mf_fit_checkpoint_share(struct fit_checkpoint *checkpoint) MUST_USE;

void mf_fit_checkpoint_clear(struct fit_checkpoint *checkpoint);
