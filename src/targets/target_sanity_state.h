// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whether a g(r) is that of a homogeneous liquid at all.
#pragma once

#include "targets/target_rdf.h"

/// g(r) of beads of one type, in three dimensions, single ones or of molecules.
struct target_state {
    const struct rdf_bins *bins;
    const double *g, *error; ///< shape [bins->count]
    const struct box *box;
    size_t count;  ///< of these beads
    double tail;   ///< mean of g over the last quarter of its range
    double bound;  ///< of them in the molecule of each, beside itself
    double inside; ///< of mf_kirkwood_buff_integrate
};

enum { TARGET_STATE_LINE = 320 };

/// Print what contradicts a homogeneous liquid, and what to do; whether there is something.
///
/// - Two phases, or nearly: 1 + ρG, the variance of the number of beads in a large volume over its
///   mean, is above 3 by three standard errors. It is 0.05 of liquids, 1 of an ideal gas, and grows
///   without bound towards a critical point; between phases g stays above 1 to the end. Of beads of
///   molecules it is over that of an ideal gas of these, 1 + `bound`.
/// - A crystal, of single beads: S(q) = 1 + ρ ∫ (g − 1) sin(qr)/(qr) 4π r² dr over the range of g
/// is above 3.3 by
///   three standard errors. Liquids freeze near a peak of 2.85 (J.-P. Hansen and L. Verlet, Phys.
///   Rev. 184, 151 (1969)), and may be undercooled. Measured, 500 Lennard-Jones particles and g to
///   half of the box: 2.6 near the triple point, 4.1 of the crystal.
///
/// Tested: test_target_sanity_state.
bool mf_target_state_print(const struct target_state *state, char line[TARGET_STATE_LINE]);

/// The same of a file that goes on beyond the cutoff; nothing where it does not.
bool mf_target_state_print_whole(const struct target_state *state,
                                 const struct target_rdf_whole *whole,
                                 char line[TARGET_STATE_LINE]);
