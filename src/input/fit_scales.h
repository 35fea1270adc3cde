// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The scales of a liquid as its g(r) tells them, for what a run file leaves out: where the
/// neighbours are, how steep the flank of g is, how far g is known to differ from 1.
#pragma once

#include "input/scene.h"
#include "input/target_files.h"

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

/// g(r) of all pair types, one behind the other. Borrowed, but `own`.
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

/// The curvature is that of parabolas through ln g at five points or, where these are too noisy, at
/// more; 0 if none tells it. A g that differs by `little` from its tail counts as its tail.
/// Threads: any. Tested: test_fit_scales.
struct fit_scales mf_fit_scales_find(const struct fit_scales_rdf *rdf, double temperature,
                                     double little);

/// Mean friction of a bead by its neighbours if ω = 1 − r/cutoff of each pair:
/// (ρ/d) Σ x_a x_b ∫ g_ab ω² dV, the rate at which its velocity is lost [1/τ]. Tested:
/// test_fit_scales.
double mf_fit_scales_friction(const struct fit_scales_rdf *rdf, double cutoff);
