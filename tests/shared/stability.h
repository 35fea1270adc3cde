// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How a run ends: in peace, with temperatures that are off, or unstable. There is no fourth.
#pragma once

#include "observe/measure.h"

enum stability {
    STABILITY_GOOD,     ///< mf_thermodynamics_assess has nothing to say
    STABILITY_DOUBTFUL, ///< it ends, and mf_thermodynamics_assess warns
    STABILITY_UNSTABLE, ///< STATUS_UNSTABLE
};

/// One integrator with the standard fluid.
struct stability_case {
    const struct integrator *integrator;
    double lambda;
    double friction; ///< γ
    double time_step;
};

/// Run the standard fluid of `count` particles for 10 τ or 300 steps, whichever is more, and then
/// measure for 5 τ or 400 steps. Prints the outcome; anything but the three fails the test.
enum stability stability_of(const struct stability_case *what, int64_t count);

/// The same of any setup, for `equilibration` steps and 100 samples every `every`.
enum stability stability_run(const struct simulation_setup *setup,
                             const struct simulation_start *start, int64_t equilibration,
                             int64_t every);
