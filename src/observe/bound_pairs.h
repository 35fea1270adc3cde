// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How long two beads stay in the well of their potential.
///
/// By transition state theory they leave it through the distance b, outwards, at the rate
///   sqrt(k_B T/(2 π μ)) w(b) / ∫_0^b w(r) dr,   w(r) = r^(d − 1) exp(−U(r)/k_B T),
/// with μ the reduced mass: H. Eyring, J. Chem. Phys. 3, 107 (1935). Friction and neighbours send
/// many of them back, so that the lifetime is a lower bound. b is where it is longest.
///
/// Samples over a few lifetimes remember how the beads were placed, and nothing in them shows it:
/// what is frozen does not scatter.
#pragma once

#include "dynamics/simulation.h"

struct bound_pairs {
    double lifetime; ///< [τ]; 0 where no time is known, as in Monte Carlo, or no potential acts
    double depth;    ///< of the well, from its bottom to b [k_B T]
    double edge;     ///< b [λ]
};

/// Tested: test_bound_pairs.
struct bound_pairs mf_bound_pairs_find(const struct simulation_setup *setup, int pair);
