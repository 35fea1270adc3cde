// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The candidate of a fit that was measured last, for the page: its curves, its error, its
/// temperature, and g(r) beside the target.
#pragma once

#include "io/json_write.h"
#include "report/watcher.h"

/// Returns NULL without memory. Tested: tests/live/test_candidate.py.
struct json_writer *mf_live_candidate_write(const struct watcher_run *run,
                                            const struct inverse_candidate *candidate);
