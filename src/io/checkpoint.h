// SPDX-License-Identifier: GPL-3.0-or-later
/// @file State on disk, from which a run goes on with the same bits.
///
/// One file, `checkpoint.bin` in the run's folder: a header, the digest of used.json, then the
/// spans in order, each with its length, and a checksum of it all (base/digest.h). Only the
/// program and processor kind that wrote it need to read it.
#pragma once

#include "base/memory.h"

#include <stdbool.h>
#include <stdint.h>

/// Save spans, whole or not at all.
enum status mf_checkpoint_save(const char *file, uint64_t digest, const struct memory_span *spans,
                               size_t count) MUST_USE;

/// Load into the same spans. BAD_INPUT if the file is of other settings (digest), another version
/// or shape, or if its checksum is not that of its bytes; nothing is loaded then.
enum status mf_checkpoint_load(const char *file, uint64_t digest, const struct memory_span *spans,
                               size_t count) MUST_USE;

/// Whether a whole checkpoint of this version is of other settings, which is why it cannot be
/// loaded. Tested: test_checkpoint.
bool mf_checkpoint_is_of_others(const char *file, uint64_t digest);

/// Load one span alone: number `number`, from 0, of a state whose other lengths depend on it.
/// Fails: as mf_checkpoint_load; IO.
enum status mf_checkpoint_load_span(const char *file, uint64_t digest, size_t number,
                                    const struct memory_span *span) MUST_USE;

/// Digest of a file's bytes (base/digest.h), with which that of the settings begins: what they only
/// name, a target or a table, is added to it.
enum status mf_checkpoint_digest(const char *file, uint64_t *digest) MUST_USE;

/// When to save: not more often than wanted, and so seldom that it takes a hundredth of a run's
/// time at most, however large the state or slow the disk. Seconds are those of the run.
struct checkpoint_pace {
    double interval; ///< at least so long between two [s]
    double next;     ///< when it is time again
};

static inline void mf_checkpoint_pace_saved(struct checkpoint_pace *pace, double begun,
                                            double ended) {
    const double work = 99 * (ended - begun);
    pace->next = ended + (work > pace->interval ? work : pace->interval);
}
