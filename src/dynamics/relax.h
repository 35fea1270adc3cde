// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Part particles that were placed upon each other.
#pragma once

#include "dynamics/simulation.h"

/// If some force is that of an overlap, shift all particles along theirs, by a few hundredths of
/// their mean spacing at most, until no force changes a velocity by more than a thermal one in a
/// time step (without velocities: moves a particle by more than its free step), or 500 times:
/// steepest descent with capped displacements. Leaves anything else as it is; the same bits for any
/// number of threads. The forces are then those of the potential alone. Fails: NO_MEMORY, as
/// mf_simulation_compute_potential; INTERRUPTED. Tested: test_relax.
enum status mf_relax_overlaps(struct simulation *simulation) MUST_USE;

/// Shift all particles along their forces, by a few hundredths of their mean spacing at most, until
/// none is above `enough` [k_B T_0/λ], or 500 times. Fails: as above.
enum status mf_relax_downhill(struct simulation *simulation, double enough) MUST_USE;
