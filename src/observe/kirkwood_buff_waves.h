// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Kirkwood and Buff's integrals of the components of a configuration (system/components.h)
/// in a closed box, by its longest waves.
///
///   G_ab = ∫ (g_ab − 1) d^dr = [S_ab(q → 0) − δ_ab]/sqrt(ρ_a ρ_b)
///
/// of the open system, with S_ab of observe/density_waves.h; J. G. Kirkwood and F. P. Buff, J.
/// Chem. Phys. 19, 774 (1951). A wave q ≠ 0 of a closed periodic box does not see that the numbers
/// N_a are fixed: S of an ideal gas is 1 at every q, whereas its g, integrated over the box, gives
/// −1/ρ. Nothing is cut off at a range, either. What is left is the way to q = 0: a straight line
/// in q² through all waves up to q_maximum, each with the same weight, as S of n waves is known to
/// S/sqrt(n). The intercept is linear in S of the waves, so that each configuration has a G of its
/// own, whose mean is G, and whose covariance with the pairs of a bin is the response of G.
///
/// Systematic error: of a term c q⁴ in S the intercept keeps −(5/21) c q_maximum⁴ (in three
/// dimensions, of many waves); where S = S(0)/(1 + ξ² q²), S is too small by the part
/// (5/21) (ξ q_maximum)⁴. Terms of 1/N from the dependence of g on the density are left out.
/// Molecules are points at their middle: what is within them makes no part of S.
/// Statistical error: that of S(0) of n waves is 2.5 S/sqrt(n) a configuration.
#pragma once

#include "observe/density_waves.h"
#include "system/component_sites.h"

struct kirkwood_buff_waves {
    struct density_waves waves;
    struct component_sites sites;
    struct box box;
    double q_maximum; ///< [1/λ]
    double *weight;   ///< shape [waves]: the intercept is Σ weight S
};

/// Waves up to q_maximum [1/λ], or, if that is 0, up to a fifth of 2π ρ^(1/d), ρ that of all sites:
/// about N/60 waves in three dimensions; but not farther than 1/R_g of the largest molecules, taken
/// as random walks whose steps are the mean distance of all beads. Must be cleared, also after a
/// failure.
/// @param[in] topology  of the molecules, or NULL
/// Fails: BAD_INPUT, without a place, if they have fewer than two lengths, or if they are too many,
/// or as mf_components_find; NO_MEMORY.
enum status mf_kirkwood_buff_waves_init(struct kirkwood_buff_waves *kb, const struct box *box,
                                        const struct composition *composition, size_t count,
                                        const struct topology *topology, double q_maximum) MUST_USE;
void mf_kirkwood_buff_waves_clear(struct kirkwood_buff_waves *kb);

/// Up to which wave number waves are taken, if a file wishes this one, or 0: none.
double mf_kirkwood_buff_waves_maximum(const struct box *box, size_t sites, size_t beads,
                                      const struct topology *topology, double wish);

/// About how many waves there are up to a wave number.
double mf_kirkwood_buff_waves_expected(const struct box *box, double q_maximum);

/// What the integrals are of: their pair types are those of G.
const struct composition *mf_kirkwood_buff_waves_components(const struct kirkwood_buff_waves *kb);

/// G of one configuration. The same bits for any number of threads.
/// @param[out] integral  shape [pairs] [λ^d]
/// Tested: test_kirkwood_buff_waves (unit, and physics: exact, by the random phase approximation,
/// and by an equation of state).
void mf_kirkwood_buff_waves_take(struct kirkwood_buff_waves *kb, const struct particles *particles,
                                 int threads, double *integral);
