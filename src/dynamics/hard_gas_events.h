// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The events of hard discs and spheres: forecasts, collisions, crossings.
#pragma once

#include "dynamics/hard_gas.h"

/// Put the bodies into their cells and foresee their events, at time 0 of an epoch. Cells and
/// calendar are empty.
/// @param[in] rate  events a time to make the calendar for [1/τ]; 0: not known yet
void mf_hard_gas_events_begin(struct hard_gas *gas, double rate);

/// At most `max` events before `time` of the epoch.
/// @return whether there is none left before `time`
bool mf_hard_gas_events_run(struct hard_gas *gas, double time, uint64_t max);
