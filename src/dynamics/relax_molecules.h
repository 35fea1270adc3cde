// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Part molecules that were placed upon each other, and unlink their rings.
#pragma once

#include "dynamics/simulation.h"

/// mf_relax_soft, then mf_relax_overlaps, and in three dimensions no two rings are linked then, by
/// which repulsion would hold them together for ever (system/rings.h). Of two that are, one is
/// drawn together at its corner that is farthest from the other, and grows again as the forces part
/// its beads. Nothing is done about rings without a potential.
/// Fails: as these; BAD_INPUT if rings are still linked after 10 times. Tested: physics/test_rings.
enum status mf_relax_molecules(struct simulation *simulation) MUST_USE;
