// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A process that goes ahead: what HDF5 crashes on, of a damaged file, ends it alone.
///
/// HDF5 1.10 believes sizes, addresses and chunks that a damaged file tells it. A child does all
/// that is done with the file before its parent does it, and says so; where it has died, the file
/// is refused. Another processor works for it, if there is one. Tested: test_trajectory_h5md.
#pragma once

#include "base/status.h"

#include <stddef.h>
#include <sys/types.h>

struct h5md_canary {
    pid_t child;   ///< 0: none, or it has ended
    int from;      ///< it
    size_t passed; ///< steps that it has come through
};

/// Begin. `go` is called in the child, which ends with it; it tells of each step. Fails: NO_MEMORY.
enum status mf_h5md_canary_begin(struct h5md_canary *canary, void (*go)(void *context, int to),
                                 void *context) MUST_USE;

/// In the child: one more step is done.
void mf_h5md_canary_tell(int to);

/// Wait until it has come through so many steps, or has ended by itself. Fails: BAD_INPUT, naming
/// the file, if it died of one.
enum status mf_h5md_canary_wait(struct h5md_canary *canary, size_t steps,
                                const char *file) MUST_USE;

void mf_h5md_canary_end(struct h5md_canary *canary);
