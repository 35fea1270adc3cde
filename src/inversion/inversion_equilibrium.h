// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whether the samples of an inversion are those of equilibrium.
///
/// The energy, the virial, the counts of each section, R_g² and R_e² of molecules are looked at in
/// the quarters of all replicas' samples (observe/stationary.h). Where one of them drifts, the
/// samples are equilibration, and as many are taken again; where it still drifts, with twice as
/// many sweeps between them. What the samples of one potential have cost so is where those of the
/// next begin, which may need half of it.
///
/// Where one of them remembers where it began, there are too few samples, and they are doubled.
/// Replicas of molecules and mixtures begin on both sides of equilibrium: as long as the two halves
/// differ by more than the scatter within them (analysis of variance), the samples are
/// equilibration, too, and what they remember is not averaged over.
#pragma once

#include "observe/stationary.h"
#include "problem/inverse.h"

#include <stdint.h>

struct inversion_state;
struct replicas;

enum { INVERSION_QUANTITY_SIZE = 32 };

/// What had not settled, with the least chance to be so in equilibrium.
struct inversion_unequilibrated {
    bool found;
    bool drifts;                            ///< something does, and not only remembers
    bool apart;                             ///< halves that began so, by more than their scatter
    bool beside_sizes;                      ///< not R_g² and R_e² of molecules alone
    char quantity[INVERSION_QUANTITY_SIZE]; ///< in words
    struct stationary is;
    uint64_t sweeps; ///< of each replica since the potential was changed
    bool for_long;   ///< they are as many as one potential may cost
};

/// Square of how far from that of equilibrium the mean of a number of the samples may be: of its
/// way along them, which it may go once more, and of its error by the scatter of the replicas, each
/// of which may remember its begin, less what the noise of the blocks makes of both: 0 on average
/// in equilibrium. Tested: test_inversion_equilibrium.
double mf_inversion_equilibrium_shift(const struct replicas *replicas, size_t number);

/// What the samples of a state forget most slowly, as a mean over its bins: a section, a size, the
/// longest waves, the energy, the pressure; or the ramp that they ask for
/// (mf_inversion_band_add_samples). Tested: test_inversion_equilibrium.
/// @param[in,out] slowest  of other states, which it stays where it is slower
void mf_inversion_equilibrium_slowest(const struct inversion_state *state,
                                      struct inverse_slowest *slowest);

/// Test the present samples. One in a thousand samples in equilibrium fails, and up to one in
/// twenty of replicas that began on both sides, which costs time alone. Fails: NO_MEMORY. Tested:
/// test_inversion_equilibrium.
enum status
mf_inversion_equilibrium_check(const struct inversion_state *state,
                               struct inversion_unequilibrated *unequilibrated) MUST_USE;

/// What the replicas remember counts as noise if they have differed by nothing else since
/// they were placed, or by less than a third of what was asked for: each goes on from a state of
/// its own of the potential before, and mf_inversion_assess has taken the scatter of their means
/// for the error. What drifts is none. Tested: test_inversion_equilibrium.
void mf_inversion_equilibrium_reset(struct inversion_state *state);
