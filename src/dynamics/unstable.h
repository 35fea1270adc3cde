// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a person is told to do about a simulation that blows up.
#pragma once

#include "dynamics/simulation.h"

enum { UNSTABLE_ADVICE_SIZE = 160 };

/// Advice for the present forces: if more than half of the largest comes from one interaction
/// beside the pairs, it is named. Fails: never. Tested: test_interactions.
void mf_unstable_advise(const struct simulation *simulation, char advice[UNSTABLE_ADVICE_SIZE]);
