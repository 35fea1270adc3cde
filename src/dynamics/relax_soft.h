// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Part molecules that were placed upon each other, without catching their bonds.
#pragma once

#include "dynamics/simulation.h"

/// Shift particles along forces of which those of pairs are nowhere above a cap, 20 and then 100
/// times k_B T over the mean spacing, so that bonds, which are not capped, draw chains through each
/// other where they cross: with the whole repulsion crossing bonds catch each other, and stay
/// stretched for ever. The slow push-off of R. Auhl, R. Everaers, G. S. Grest, K. Kremer and S. J.
/// Plimpton, J. Chem. Phys. 119, 12718 (2003), section III, by steepest descent. Before
/// mf_relax_overlaps, which does the rest. Nothing without a potential.
/// Fails: NO_MEMORY, as mf_simulation_compute_potential. Tested: physics/test_molecules.
enum status mf_relax_soft(struct simulation *simulation) MUST_USE;
