// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The forces of a simulation as it stands, without a trace in it.
#pragma once

#include "dynamics/simulation.h"

/// A simulation of the same particles under the potentials alone, those of the pairs and of all
/// interactions, whose forces and sums are those of the present positions. An integrator's own
/// forces may be of the middle of its step, with friction and noise, or of an earlier step; they
/// and the neighbour list stay as they are, so that what is looked at goes on with the same bits.
/// @param[out] look  to be cleared by mf_simulation_clear
/// Fails: NO_MEMORY, UNSTABLE as a neighbour search. Tested: cli/test_snapshots.
enum status mf_simulation_look(const struct simulation *simulation,
                               struct simulation *look) MUST_USE;

/// Σ r_a F_b of all pairs and bonds under the potentials at the present positions [k_B T_0], of
/// which the trace is the virial: what the pressure along each axis has beside ρ k_B T.
/// Fails: BAD_INPUT, without a place, if an interaction adds to the virial alone; as above.
/// Tested: test_virial.
enum status mf_simulation_look_virial(const struct simulation *simulation,
                                      double virial[3][3]) MUST_USE;
