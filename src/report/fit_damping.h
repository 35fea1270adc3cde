// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a person has changed of a fit while it ran.
#pragma once

#include "io/json_write.h"
#include "report/progress.h"

#include <stdint.h>

enum { FIT_DAMPINGS_MAX = 256 };

/// The damping of an inversion from an iteration on; plain data, which a checkpoint keeps.
struct fit_dampings {
    uint64_t count;
    struct fit_damping {
        uint64_t iteration; ///< the first whose step has it
        double damping;
    } change[FIT_DAMPINGS_MAX];
};

/// Ask who watches before an iteration, keep what is new, and say it: of one iteration the last
/// wish counts. Whether anything has changed.
/// @param[in,out] damping  of the method, or NULL: it has none
bool mf_fit_damping_ask(struct fit_dampings *changes, uint64_t iteration, double *damping,
                        struct progress *progress);

/// Put "changed", a list, if there are any. Tested: tests/live/test_damping.py.
void mf_fit_damping_write(const struct fit_dampings *changes, struct json_writer *writer);
