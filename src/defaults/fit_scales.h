// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The scales of a liquid as its g(r) tells them, for what a run file leaves out: where the
/// neighbours are, how steep the flank of g is, how far g is known to differ from 1.
#pragma once

#include "scene/scene.h"
#include "targets/target_files.h"

struct fit_scales {
    double core;         ///< pairs hardly come nearer, of any type [λ]
    double neighbour;    ///< distance of the first neighbours, the least of all pair types [λ]
    double shell;        ///< where the widest first shell of neighbours ends [λ]
    double curvature;    ///< largest of −k_B T (ln g)'' where pairs come near [k_B T_0/λ²]
    double curvature_at; ///< [λ]
    double noise;        ///< standard error of g, rms over the bins with pairs
    double seen;  ///< g differs from its tail by more than its noise, and `little`, up to here [λ]
    double range; ///< upper edge of the last bin [λ]
};

/// g(r) of all pair types, one after the other. Borrowed, but `own`.
struct fit_scales_rdf {
    struct rdf_bins bins;
    const struct composition *composition;
    int dimensions;
    double density;          ///< of all beads [1/λ^d]
    const double *g, *error; ///< shape [pairs, bins]
    double *own;             ///< made of a potential; NULL
};

/// g(r) of the targets or, without it, that of a gas with the scene's potential, exp(−Φ/k_B T), as
/// if it were known within 0.001; `bins.count` is 0 with neither. Fails: NO_MEMORY.
enum status mf_fit_scales_rdf_init(struct fit_scales_rdf *rdf, const struct target_files *files,
                                   const struct scene *scene) MUST_USE;
void mf_fit_scales_rdf_clear(struct fit_scales_rdf *rdf);

/// How many bins can be joined to one without loss: the most with which g between the wider bins,
/// by cubics through them, is as good as g itself, for any fewer, too.
///
/// The cubic through four points is off by (3/128) δ⁴g in their middle, δ⁴ the fourth difference.
/// What of it is more than three standard errors must everywhere be within the noise of the wider
/// bin, or what a fit resolves, `finest`, but not more than `coarsest`, both times sqrt(g) where g
/// is below 1. Where g is steep wide bins would tell nothing of it; bins narrower than that make Φ
/// rough, since nothing but noise tells them apart. Tested: test_fit_scales.
size_t mf_fit_scales_joined(const struct fit_scales_rdf *rdf, double finest, double coarsest);

/// Join so many bins of g to one. Fails: NO_MEMORY.
enum status mf_fit_scales_rdf_join(struct fit_scales_rdf *rdf, size_t of) MUST_USE;

/// The curvature is that of parabolas through ln g at five points or, where these are too noisy, at
/// more; 0 if none tells it. A g that differs by `little` from its tail counts as its tail.
/// Threads: any. Tested: test_fit_scales.
struct fit_scales mf_fit_scales_find(const struct fit_scales_rdf *rdf, double temperature,
                                     double little);

/// A g that differs from 1 by less, on the mean of five bins, ends: layers farther out are made by
/// those inside, not by forces of their own. Hexane with a cutoff of 1.3 nm, beyond which g differs
/// from 1 by 0.03 at most, has g from there to 2 nm within 0.003 (lab/molecules.md).
static const double fit_scales_little = 0.03;

/// rms of the errors of g up to `range` that one sample of so many beads in a box of that density
/// leaves, if pairs are independent.
double mf_fit_scales_noise_of_sample(const struct fit_scales_rdf *rdf, const struct box *box,
                                     double count, double range);

/// Mean friction of a bead by its neighbours if ω = 1 − r/cutoff of each pair:
/// (ρ/d) Σ x_a x_b ∫ g_ab ω² dV, the rate at which its velocity is lost [1/τ]. Tested:
/// test_fit_scales.
double mf_fit_scales_friction(const struct fit_scales_rdf *rdf, double cutoff);
