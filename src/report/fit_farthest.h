// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What of a fit's targets its verification meets least, in words.
#pragma once

#include "report/fit_output.h"

/// Targets that are fitted, and those that are only compared with what was fitted to them.
enum fit_judged { FIT_TARGETS_FITTED, FIT_TARGETS_COMPARED };

/// Where errors are so badly known that noise may reach ten of them, nothing is met least.
struct fit_farthest {
    enum fit_judged judged;
    const struct fit_file *state;
    int kind;
    const struct verify_agreement *agreement; ///< NULL: the errors of none are known
};

struct fit_farthest mf_fit_farthest_find(const struct fit_file *fit,
                                         const struct verification *verification,
                                         enum fit_judged judged);

/// "etd from 0.1 to 0.2 ps for r_0 from 0.6 to 0.7 nm by 5.1 times its statistical error (by
/// chance up to 3.9)". The error is that of the target and of the simulations together; what is
/// only compared is off by what the noise of the fitted targets makes of the potential, too.
/// Tested: test_fit_closing.
enum { FIT_FARTHEST_SIZE = 320 };
void mf_fit_farthest_describe(const struct fit_farthest *farthest, char text[FIT_FARTHEST_SIZE]);
