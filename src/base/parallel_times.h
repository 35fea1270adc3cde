// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How long tasks take that ranks may share: by the number of tasks that are done together.
#pragma once

#include "base/statistics.h"

#include <stddef.h>

enum { PARALLEL_MAX_SIZES = 16 };

struct parallel_times {
    size_t sizes;
    struct parallel_size {
        size_t tasks; ///< of a round; beyond PARALLEL_MAX_SIZES a round counts with its nearest
        double rounds, done; ///< and tasks of them
        double seconds;      ///< of processor time that they took
        double squares;      ///< of each task's deviation from its round's mean, over that
        double waited;       ///< [s] from begin to end of these rounds
    } size[PARALLEL_MAX_SIZES];
};

/// What this process has seen since it began.
struct parallel_times mf_parallel_times(void);

/// Of mf_parallel_try: a round of so many tasks, how long they took, and the round.
void mf_parallel_times_add(size_t tasks, const struct running_mean *seconds, double waited);
