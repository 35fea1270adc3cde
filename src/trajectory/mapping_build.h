// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How a mapping is made: which atoms are which bead, and their masses.
#pragma once

#include "trajectory/mapping.h"

/// Find types, beads and their atoms, with weights that are 0 or, for centres of geometry, 1/count.
enum status mf_mapping_build(struct mapping *mapping, const struct mapping_plan *plan,
                             const struct structure *structure) MUST_USE;
