// SPDX-License-Identifier: GPL-3.0-or-later
/// @file U of bonds, angles and dihedrals as smooth as its target lets it be.
///
/// A fit begins with −k_B T ln(p/J) and takes steps that are smooth, or in bins of few counts none:
/// what noise the target has in such bins stays in U, bin by bin. The band takes for granted that a
/// prior holds U there. So the result of a fit becomes the most probable curve y of that prior,
///   minimise  Σ_a F_a (y_a − U_a − u_a)² + s |D(y − law)|²/(k_B T)²,   F_a = S_a²/(σ_a k_B T)²,
/// with S counts of the samples, σ² the variance of their excess, and u = k_B T ln(S/S*) of a
/// method that goes by the present samples alone (inversion_rule.memoryless), which has not stepped
/// where its counts are within their errors; else 0. Terms count as independent of each other, as
/// in Boltzmann inversion: C of fewer samples than bins would say that well-known bins are not.
/// The law is the parabola, or of a dihedral the Fourier series to cos 3φ and sin 3φ, that is
/// nearest to U by p; its curvature is no deviation.
///
/// s is 1, or less where the target shows that U bends more than the prior expects: a bond of
/// several wells (inversion->smoothness). 24 twins of 40 samples each, whose U was off by 1.9
/// to 3.6 stated errors where 2 to 100 counts were expected: lab/molecules.md.
#pragma once

#include "inversion/imc_solve.h"

struct inversion;

/// Find how smooth each group is, by its target. Fails: NO_MEMORY.
enum status mf_inversion_smooth_init(struct inversion *inversion) MUST_USE;

/// The shapes of all blocks with which the prior of the band is that of the result.
/// @param[out] shape  shape [blocks]
void mf_inversion_smooth_shapes(const struct inversion *inversion, struct imc_shape *shape);

/// Replace U of all groups in phi by the most probable curves; of few coefficients they stay.
/// Fails: NO_MEMORY. Tested: test_inversion_smooth.
enum status mf_inversion_smooth(struct inversion *inversion) MUST_USE;
