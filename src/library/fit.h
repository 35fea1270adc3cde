// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The state of a fit of the library.
#pragma once

#include "defaults/fit_file.h"
#include "mesofit/fit.h"
#include "problem/parametrisation.h"

#include <stdatomic.h>

struct mesofit_fit {
    struct fit_file file;
    struct unknowns unknowns;
    struct parametrisation parametrisation; ///< of a method of the kind INVERSE_MATCHING
    void *state;                            ///< of file.method
    struct inverse_step step;
    bool iterated;
    atomic_bool cancel;
    mesofit_fit_progress *progress;
    void *context;
};
