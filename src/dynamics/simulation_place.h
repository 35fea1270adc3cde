// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where the particles of a simulation begin, and with what.
#pragma once

#include "dynamics/simulation.h"

/// Place the particles as the setup says, molecules along their bonds, and give them attributes,
/// orientations and velocities. @param[in] start  of PLACEMENT_FILE, else NULL
/// Fails: BAD_INPUT (no room, orientations that nobody turns), NO_MEMORY.
enum status mf_simulation_place(struct simulation *simulation,
                                const struct simulation_start *start) MUST_USE;
