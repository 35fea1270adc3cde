// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a person has changed of a simulation while it ran.
#pragma once

#include "dynamics/simulation_change.h"
#include "io/json_write.h"
#include "io/units_scale.h"
#include "report/progress.h"

enum { SIMULATE_CHANGES_MAX = 256 };

/// The last ones; plain data, which a checkpoint keeps.
struct simulate_changes {
    size_t count; ///< that are kept
    struct simulation_change change[SIMULATE_CHANGES_MAX];
};

/// Keep one more: where nothing has passed since the last one, in its place. False if there are too
/// many.
bool mf_simulate_changes_add(struct simulate_changes *changes,
                             const struct simulation_change *change);

/// The last one, or NULL.
const struct simulation_change *mf_simulate_changes_last(const struct simulate_changes *changes);

/// Put "changed", a list, if there are any. Tested: tests/live/test_changes.py.
void mf_simulate_changes_write(const struct simulate_changes *changes, struct json_writer *writer);

/// Say what the last one is.
void mf_simulate_changes_print(const struct simulate_changes *changes, const struct units *units,
                               struct progress *to);
