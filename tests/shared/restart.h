// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A simulation saved and loaded again.
#pragma once

#include "dynamics/simulation.h"

/// Exchange the simulation for a new one of the same setup with the same state.
void restart_simulation(struct simulation *simulation);

/// Both have the same bits: particles, step and number of lists built.
void restart_assert_same(const struct simulation *a, const struct simulation *b);
