// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Exchanges of beads of different types, beside the moves of Metropolis's Monte Carlo.
///
/// Two beads, of two types that are drawn, each of these with the same probability, change places.
/// In a dense liquid a bead needs hundreds of sweeps to go as far as its neighbours are, and the
/// concentrations change by beads that go through the box; beads of about the same size take each
/// other's place in one move. D. Gazzillo and G. Pastore, Chem. Phys. Lett. 159, 388 (1989).
#pragma once

#include "dynamics/metropolis.h"

/// The exchanges of a sweep, after its moves of beads, whose list of neighbours is used.
/// @param[in,out] place  shape [particles], where each id stands: what is exchanged follows
/// Tested: test_exchange.
void mf_exchange_pass(struct metropolis *metropolis, uint32_t *place);
