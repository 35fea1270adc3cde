// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Forces beside the pair law: the record of an interaction.
///
/// A simulation has a list of them, empty in most scenes. To add one, write a file with its record.
#pragma once

#include "base/memory.h"
#include "forces/pair.h"

struct interaction {
    const char *name;
    const char *summary; ///< the formula and its source, one line
    /// Add its forces to particles->force at the present positions, and to `sums`, if `wants` asks
    /// for them, its energy [k_B T_0] and its virial Σ r·F [k_B T_0].
    enum status (*add)(void *state, struct particles *particles, uint64_t step,
                       enum pair_wants wants, struct pair_sums *sums);
    /// List what of its state a checkpoint must keep; returns the number of spans. NULL: nothing.
    size_t (*spans)(void *state, struct memory_span *spans);
};

/// An interaction at work. Borrowed.
struct interaction_use {
    const struct interaction *kind;
    void *state;
};
