// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Kirkwood and Buff's integral of a g(r), and the compressibility that it says.
#pragma once

#include "observe/density_waves.h"
#include "observe/observable.h"
#include "observe/rdf.h"
#include "system/component_sites.h"

struct kirkwood_buff {
    double integral, integral_error;               ///< G [λ³]
    double compressibility, compressibility_error; ///< ρ k_B T κ_T = 1 + ρ G = S(0) [1]
};

/// G = ∫ (g − 1) d³r of the infinite system, extrapolated from what is known up to the range L of
/// the bins:
///   G ≈ ∫_0^L (g − 1) 4π r² u(r/L) dr,   u(x) = 1 − 23x³/8 + 3x⁴/4 + 9x⁵/8.
/// P. Krüger and T. J. H. Vlugt, Phys. Rev. E 97, 051301 (2018), whose u makes of the integrals
/// over finite spheres (P. Krüger et al., J. Phys. Chem. Lett. 4, 235 (2013)) what converges as
/// 1/L³. The integral over each bin is exact for constant g in it; below the first g is 0. Pairs
/// that g leaves out, as those that molecules exclude, are near each other and belong to G:
/// `inside` is what they add to it. Of N particles g normalised by N (N − 1) has a tail of −ρG/N
/// (observe/finite_size.h), which is taken out:
///   ρG = I/(1 − ∫ 4π r² u dr/V),   I the integral, and what is inside, times ρ.
/// Errors of bins count as independent; those by sampling compensate each other in a liquid, which
/// makes the standard error too large rather than too small. A g whose range is a sphere larger
/// than the box is not that of its system: nothing is known then, all is NaN.
/// @param[in] g, error   shape [bins.count]; an error that is NaN counts as 0
/// @param[in] box, count  of the system that g comes from, in three dimensions
/// @param[in] inside      volume times the share of all pairs that g leaves out [λ³]
/// Tested: test_kirkwood_buff.
struct kirkwood_buff mf_kirkwood_buff_integrate(const struct rdf_bins *bins, const double *g,
                                                const double *error, const struct box *box,
                                                size_t count, double inside);

/// The same with errors that also have the scatter of G with its range, as the last oscillations
/// may be cut off.
struct kirkwood_buff mf_kirkwood_buff_of_range(const struct rdf_bins *bins, const double *g,
                                               const double *error, const struct box *box,
                                               size_t count, double inside);

/// The same as it is told: NaN where the range ends before g comes to 1, within three errors and
/// what a finite system makes of its tail, as most of G is then beyond; and no errors where g has
/// none. Tested: test_kirkwood_buff.
struct kirkwood_buff mf_kirkwood_buff_known(const struct rdf_bins *bins, const double *g,
                                            const double *error, const struct box *box,
                                            size_t count, double inside);

// Kirkwood and Buff's integrals as an observable and a target.

struct kirkwood_buff_settings {
    double q_maximum; ///< of the waves [1/λ]; 0: mf_kirkwood_buff_waves_init chooses
};

extern const struct field mf_kirkwood_buff_observable_fields[]; ///< of the settings

extern const struct observable mf_kirkwood_buff_observable;

/// Add a value and its error of a pair of components to a summary, as "kirkwood_buff_A-B" and
/// "kirkwood_buff_error_A-B"; without types "kirkwood_buff" and "kirkwood_buff_error". What is not
/// known is left out.
/// @param[in] what  "kirkwood_buff", or what begins so
void mf_kirkwood_buff_write(struct json_writer *writer, const char *what,
                            const struct composition *components, size_t pair, double value,
                            double error);

/// Its target's number (mf_observable_kind): one value a pair of components, in their order.
int mf_kirkwood_buff_kind(void);

// Kirkwood and Buff's integrals of the components of a configuration (system/components.h)
// in a closed box, by its longest waves.
//
//   G_ab = ∫ (g_ab − 1) d^dr = [S_ab(q → 0) − δ_ab]/sqrt(ρ_a ρ_b)
//
// of the open system, with S_ab of observe/density_waves.h; J. G. Kirkwood and F. P. Buff, J.
// Chem. Phys. 19, 774 (1951). A wave q ≠ 0 of a closed periodic box does not see that the numbers
// N_a are fixed: S of an ideal gas is 1 at every q, whereas its g, integrated over the box, gives
// −1/ρ. Nothing is cut off at a range, either. What is left is the way to q = 0: a straight line
// in q² through all waves up to q_maximum, each with the same weight, as S of n waves is known to
// S/sqrt(n). The intercept is linear in S of the waves, so that each configuration has a G of its
// own, whose mean is G, and whose covariance with the pairs of a bin is the response of G.
//
// Systematic error: of a term c q⁴ in S the intercept keeps −(5/21) c q_maximum⁴ (in three
// dimensions, of many waves); where S = S(0)/(1 + ξ² q²), S is too small by the part
// (5/21) (ξ q_maximum)⁴. Terms of 1/N from the dependence of g on the density are left out.
// Molecules are points at their middle: what is within them makes no part of S.
// Statistical error: that of S(0) of n waves is 2.5 S/sqrt(n) a configuration.

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

/// What the integrals are of: their pair types are those of G.
const struct composition *mf_kirkwood_buff_waves_components(const struct kirkwood_buff_waves *kb);

/// G of one configuration. The same bits for any number of threads.
/// @param[out] integral  shape [pairs] [λ^d]
/// Tested: test_kirkwood_buff_waves (unit, and physics: exact, by the random phase approximation,
/// and by an equation of state).
void mf_kirkwood_buff_waves_take(struct kirkwood_buff_waves *kb, const struct particles *particles,
                                 int threads, double *integral);
