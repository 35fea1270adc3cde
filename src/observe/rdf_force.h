// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Radial distribution function from forces: less noise from the same configurations.
///
/// For any periodic, piecewise differentiable field A(r) the canonical distribution gives
///   ⟨Σ_pairs ∇·A(r_ij)⟩ = −β ⟨Σ_pairs ½ (F_i − F_j)·A(r_ij)⟩
/// (integrate ∇·(A e^{−βU}) over the box; F are the total conservative forces). With A = r̂ a(r),
/// nearest images, a = 0 at the range R ≤ L/2 and beyond, and continuous at 0, nothing is left out:
/// the identity is exact for any number of particles and any range. Let Q(r) grow from 0 to 1
/// within bin k as the volume does, 1_k be the bin and 1_R the ball of the range, v their volumes,
/// I = N(N − 1)/(2V), B = β/(Ω I), Ω = 4π (2π in 2D), and per configuration
///   u = ½ (F_i − F_j)·r_ij / r^d,   h_k = S_k/(I v_k),   L = Σ_pairs 1_R / (I v_R).
///
/// - From zero: A = −r⃗ (1 − Q)/(Ω r^d) has ∇·A = 1_k/v_k − δ(r):
///     z_k = B Σ_pairs u (1 − Q),   ⟨z_k⟩ = g_k − g(0).
///   Pairs beyond the bin do not matter. It is g if no two particles sit on each other.
/// - From infinity: A = r⃗/Ω (Q/r^d − 1/R^d) has ∇·A = 1_k/v_k − 1_R/v_R, whatever g(0) is:
///     g_k = ⟨L⟩ − B ⟨Σ_pairs u (Q − (r/R)^d)⟩ = ⟨z_k + D⟩,
///     D = L − K,   K = B Σ_pairs u (1 − (r/R)^d).
///   D is one number of a configuration, with mean g(0). The usual form, 1 − B Σ_{r>r_k} u, forgets
///   the pairs beyond R and is off by g(R) − 1 and by the finite size; here the pairs in range are
///   counted instead, which costs little: their number hardly fluctuates in a liquid.
/// - Combined: z_k + λ_k D with the λ_k of least variance, −cov(z_k, D)/var(D).
/// - Counted: K is the mean of z over the ball, so s = ⟨L⟩/⟨K⟩ makes s z have the number of pairs
///   that was counted, and β drops out. With the histogram, h + w_k (s z − h), and the w_k of least
///   variance: this is what `mesofit` uses.
///
/// D. Borgis, R. Assaraf, B. Rotenberg and R. Vuilleumier, Mol. Phys. 111, 3486 (2013); S. W.
/// Coles, E. Mangaud, D. Frenkel and B. Rotenberg, J. Chem. Phys. 154, 191101 (2021).
///
/// Configurations that a time step has distorted do not obey the identity. Groot and Warren's fluid
/// at Δt = 0.04 (configurational temperature 1.055): the rms difference from the histogram is 0.038
/// from zero, 0.022 from infinity, 0.003 counted. README has more.
#pragma once

#include "base/memory.h"
#include "curves/table.h"
#include "observe/rdf.h"

/// How g is measured, and the names of that in files.
enum rdf_force_estimator { RDF_FORCE_NOT_USED, RDF_FORCE_USED };
extern const char *const mf_rdf_force_estimators[]; ///< "histogram", "force", NULL

enum rdf_force_version {
    RDF_FORCE_FROM_ZERO,
    RDF_FORCE_FROM_INFINITY,
    RDF_FORCE_COMBINED,
    RDF_FORCE_COUNTED,
};

/// Sums over samples for each bin: h, z and their products with each other and with D.
enum rdf_force_sum {
    RDF_FORCE_H,
    RDF_FORCE_Z,
    RDF_FORCE_HH,
    RDF_FORCE_HZ,
    RDF_FORCE_ZZ,
    RDF_FORCE_HD,
    RDF_FORCE_ZD,
    RDF_FORCE_SUMS
};

/// Sums over samples of what belongs to no bin.
struct rdf_force_totals {
    double samples, level, difference, square; ///< 1, L, D, D²
};

/// Pairs of one configuration in a bin: their number, Σ u, Σ u r^d.
struct rdf_force_bin {
    double pairs, flux, virial, unused;
};

/// Accumulates configurations into consecutive blocks.
struct rdf_force {
    struct rdf_bins bins;
    struct box box;
    size_t particle_count;
    const struct table *potential; ///< borrowed
    double temperature;            ///< of the distribution [k_B T_0]
    size_t planned, samples, blocks;
    double *sums;                    ///< shape [blocks, RDF_FORCE_SUMS, bins.count]
    struct rdf_force_totals *totals; ///< shape [blocks]
    struct rdf_force_bin *pairs;     ///< shape [bins.count + 2]: below, the bins, beyond
    float (*force)[4];               ///< shape [particle_count]: of the potential alone
    bool needs_own_list;             ///< the range exceeds that of the simulation's list
    struct particles own_particles;
    struct neighbours manifest;
};

/// Whether a potential keeps particles apart, so that g(0) = 0: Φ(0) ≥ 10 k_B T. Groot and Warren's
/// fluid, with 12.5, has a g(0) below 0.004.
bool mf_rdf_force_applies(const struct table *potential, double temperature);

/// Prepare for `planned` samples of a system whose list is complete up to `list_cutoff`.
/// Fails: NO_MEMORY; BAD_INPUT if the box is shorter than twice the range of the bins.
enum status mf_rdf_force_init(struct rdf_force *force, const struct rdf_bins *bins,
                              const struct box *box, size_t particle_count,
                              const struct table *potential, double temperature, double list_cutoff,
                              size_t planned) MUST_USE;
void mf_rdf_force_clear(struct rdf_force *force);

/// Add the present configuration. Its conservative forces are computed by a pass of its own; the
/// forces of the particles come back as they were. The fractions must be those of the positions.
/// @param[in] neighbours  half list, complete for the range, the same as in mf_rdf_force_init; not
///                        read if that was beyond the list
/// Fails: NO_MEMORY. Tested: test_rdf_force_brute_force.
enum status mf_rdf_force_sample(struct rdf_force *force, struct particles *particles,
                                const struct neighbours *neighbours) MUST_USE;

/// g and its standard error by leaving out blocks of all replicas (jackknife), the combination's
/// weights each time, so that what they cost is in the error.
/// @param[in]  replicas  shape [count], same bins, box and particle number
/// @param[out] g, error  shape [bins.count]; error may be NULL
/// Fails: NO_MEMORY. Tested: test_rdf_force (physics).
enum status mf_rdf_force_result(const struct rdf_force *replicas, size_t count,
                                enum rdf_force_version version, double *g, double *error) MUST_USE;

/// @name Restart
enum { RDF_FORCE_SPANS = 3 };
size_t mf_rdf_force_spans(struct rdf_force *force, struct memory_span *spans);
