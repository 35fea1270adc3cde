// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The message about a simulation that blows up.
#pragma once

#include "dynamics/simulation.h"

/// UNSTABLE, with the step, what is wrong, the largest force and an advice for the present forces:
/// if more than half of the largest comes from one interaction beside the pairs, it is named.
/// Tested: test_interactions.
enum status mf_unstable_fail(const struct simulation *simulation, const char *what) MUST_USE;
