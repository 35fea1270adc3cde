// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How far a result is from its targets, in the same measure for all of them.
#pragma once

#include "report/result.h"

/// Find `error_over_noise`, the rms of rmse over noise of all targets that a summary tells, in
/// which 1 is what statistics alone leave, and `worst`, the target with the largest of them. NaN
/// and "" if there is none, as of a simulation. Tested: test_compare.
void mf_result_distance_find(struct result_summary *summary);
