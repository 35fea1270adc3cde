// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The structure of molecules by themselves, for the hypernetted chain
/// (inversion/hnc_closure.h).
///
/// Free molecules, beads of which act on each other by their bonds, angles and dihedrals alone, are
/// sampled once, before the start of a fit. Where the pairs that they exclude leave g of all types
/// independent of each other, the hypernetted chain makes the start and the steps far from the
/// target, as of single beads: of soft chains of 30 beads in a solvent it starts within 0.3 k_B T
/// of the truth, where −k_B T ln g, which of chains has their own shape in it, lets them collapse.
#pragma once

#include "inversion/hnc_closure.h"
#include "inversion/inversion_state.h"

/// Sample the molecules of a state and fill `inside`, if it has any and the hypernetted chain can
/// use it. The potential of the pairs of `phi`, which is the state's, is lost.
/// Fails: as mf_replicas_run. Tested: test_inversion_intramolecular.
enum status mf_inversion_intramolecular_find(struct inversion_state *state, double *phi,
                                             const struct inverse_listener *listener) MUST_USE;

/// Whether the hypernetted chain knows the state's liquid: g of all its pairs, of single beads, or
/// of molecules whose structure was found to be of use.
bool mf_inversion_knows_intramolecular(const struct inversion_state *state);

/// What it knows.
struct hnc_liquid mf_inversion_liquid(const struct inversion_state *state);
