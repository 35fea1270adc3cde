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

/// Shift particles along forces of which those of pairs are nowhere above a cap, 20 and then 100
/// times k_B T over the mean spacing, so that bonds, which are not capped, draw chains through each
/// other where they cross: with the whole repulsion crossing bonds catch each other, and stay
/// stretched for ever. The slow push-off of R. Auhl, R. Everaers, G. S. Grest, K. Kremer and S. J.
/// Plimpton, J. Chem. Phys. 119, 12718 (2003), section III, by steepest descent. Before
/// mf_relax_overlaps, which does the rest. Nothing without a potential.
/// Fails: NO_MEMORY, as mf_simulation_compute_potential. Tested: physics/test_molecules.
enum status mf_relax_soft(struct simulation *simulation) MUST_USE;
